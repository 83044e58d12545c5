//! A matrix of numbers as a file holds it.

/// Numbers of a height file before unit, scale and detrending.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Matrix {
    /// Numbers in the file's unit, shape `[rows, columns]`, row-major; a missing one is NaN.
    pub(super) values: Vec<f64>,
    /// Rows, along y.
    pub(super) rows: usize,
    /// Columns, along x.
    pub(super) columns: usize,
    /// Size along x and y, if the file states it.
    pub(super) size: Option<Size>,
    /// Metres per unit of the numbers, if the file states it.
    pub(super) unit: Option<f64>,
    /// Whether the numbers are shades of grey, from 0 (black) to 1 (white).
    pub(super) grey: bool,
    /// Warnings for the user.
    pub(super) warnings: Vec<String>,
}

impl Matrix {
    /// Numbers of shape `[rows, columns]` of which nothing else is known.
    pub(super) fn new(values: Vec<f64>, [rows, columns]: [usize; 2]) -> Self {
        Matrix {
            values,
            rows,
            columns,
            ..Matrix::default()
        }
    }
}

/// Size of a map along x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Size {
    /// In metres.
    Metres([f64; 2]),
    /// In the unit of the numbers: for points with coordinates x, y, z without stated units.
    LikeHeights([f64; 2]),
}
