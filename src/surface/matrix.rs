//! A matrix of numbers as a file holds it.

/// Numbers of a height file before anything is done to them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Matrix {
    /// Numbers in the file's unit, shape `[rows, columns]`, row-major; a missing one is NaN.
    pub(super) values: Vec<f64>,
    /// Rows, along y.
    pub(super) rows: usize,
    /// Columns, along x.
    pub(super) columns: usize,
    /// Size along x and y, m, where the file says it.
    pub(super) size: Option<[f64; 2]>,
    /// Metres per unit of the numbers, where the file says it.
    pub(super) unit: Option<f64>,
    /// What the author should know.
    pub(super) warnings: Vec<String>,
}
