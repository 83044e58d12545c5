//! Values on the grid that are given as an array.

use std::fmt;
use std::sync::Arc;

use serde::ser::{Serialize, SerializeStruct, Serializer};

/// One number a point of the grid, shape `[ny, nx]`, row-major: point (ix, iy) is element `iy * nx + ix`.
///
/// Copies share the numbers.
#[derive(Clone, PartialEq)]
pub struct GridValues {
    points: [usize; 2],
    values: Arc<Vec<f64>>,
}

impl GridValues {
    /// The values of `points` = (nx, ny) points. That there are as many, and that they are finite, is checked
    /// where they are used.
    pub fn new(values: impl AsRef<[f64]>, points: [usize; 2]) -> Self {
        GridValues::from_vec(values.as_ref().to_vec(), points)
    }

    /// The same without a copy of the values.
    pub fn from_vec(values: Vec<f64>, points: [usize; 2]) -> Self {
        GridValues {
            points,
            values: Arc::new(values),
        }
    }

    /// Points along x and y.
    pub fn points(&self) -> [usize; 2] {
        self.points
    }

    /// The numbers.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The numbers, shared with whoever holds them too.
    pub(crate) fn shared(&self) -> Arc<Vec<f64>> {
        Arc::clone(&self.values)
    }

    /// CRC-32 of the numbers, by which they are told from others.
    fn checksum(&self) -> u32 {
        let mut checksum = crc32fast::Hasher::new();
        for value in self.values.iter() {
            checksum.update(&value.to_le_bytes());
        }
        checksum.finalize()
    }
}

/// Identified by points and checksum: no file of a scene holds an array.
impl Serialize for GridValues {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut table = to.serialize_struct("GridValues", 2)?;
        table.serialize_field("points", &self.points)?;
        table.serialize_field("checksum", &self.checksum())?;
        table.end()
    }
}

impl fmt::Debug for GridValues {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Not millions of numbers.
        formatter
            .debug_struct("GridValues")
            .field("points", &self.points)
            .finish_non_exhaustive()
    }
}
