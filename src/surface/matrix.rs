//! A matrix of numbers as a file holds it.

use super::file_error::FileError;
use super::formats::Numbers;

/// Most numbers of the rows that are read and passed over at once, or those of one row.
pub(super) const PASSED: usize = 1 << 20;

/// Numbers of a height file before unit, scale and detrending.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Matrix<V = Vec<f64>> {
    /// Numbers in the file's unit, shape `[rows, columns]`, row-major; a missing one is NaN.
    pub(super) values: V,
    /// Rows, along y.
    pub(super) rows: usize,
    /// Columns, along x.
    pub(super) columns: usize,
    /// Size along x and y, if the file states it.
    pub(super) size: Option<Size>,
    /// Metres per unit of the numbers, if the file states it.
    pub(super) unit: Option<f64>,
    /// Metres per unit of the places of a profile, if the file states it.
    pub(super) lateral_unit: Option<f64>,
    /// The column of the places of a profile in two columns, if their heads name it.
    pub(super) places: Option<usize>,
    /// Whether the numbers are shades of grey, from 0 (black) to 1 (white).
    pub(super) grey: bool,
    /// A warning for whom the first row and the first column are heights: they look like places.
    pub(super) frame: Option<String>,
    /// Warnings for the user.
    pub(super) warnings: Vec<String>,
}

/// What a file says of its numbers, which are still to be read.
pub(super) type Map = Matrix<Numbers>;

impl<V> Matrix<V> {
    /// Numbers of shape `[rows, columns]` of which nothing else is known.
    pub(super) fn new(values: V, [rows, columns]: [usize; 2]) -> Self {
        Matrix {
            values,
            rows,
            columns,
            size: None,
            unit: None,
            lateral_unit: None,
            places: None,
            grey: false,
            frame: None,
            warnings: Vec::new(),
        }
    }

    /// The numbers, and the same with others in their place.
    fn replace<W>(self, values: W) -> (V, Matrix<W>) {
        let replaced = Matrix {
            values,
            rows: self.rows,
            columns: self.columns,
            size: self.size,
            unit: self.unit,
            lateral_unit: self.lateral_unit,
            places: self.places,
            grey: self.grey,
            frame: self.frame,
            warnings: self.warnings,
        };
        (self.values, replaced)
    }

    /// The numbers, and the same without them.
    pub(super) fn split(self) -> (V, Matrix<()>) {
        self.replace(())
    }
}

impl Matrix<()> {
    /// The same with numbers.
    pub(super) fn with<V>(self, values: V) -> Matrix<V> {
        self.replace(values).1
    }
}

impl Map {
    /// Reads all of its numbers.
    ///
    /// # Errors
    /// The file cannot be read, and too little memory.
    pub(super) fn read(self) -> Result<Matrix, FileError> {
        let (numbers, header) = self.split();
        let values = numbers.all([header.rows, header.columns])?;
        Ok(header.with(values))
    }
}

impl From<Matrix> for Map {
    fn from(matrix: Matrix) -> Map {
        let (values, header) = matrix.split();
        header.with(Numbers::Held(values))
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
