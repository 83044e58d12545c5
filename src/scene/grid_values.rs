//! Values on the grid that are given as an array.

use std::fmt;

use serde::ser::{Serialize, SerializeStruct, Serializer};

use crate::shared_values::SharedValues;

/// Numbers that a checksum takes at a time: a few kilobytes, since it is slow on eight bytes.
const SUMMED: usize = 512;

/// One number a point of the grid, shape `[ny, nx]`, row-major: point (ix, iy) is element `iy * nx + ix`.
///
/// Copies share the numbers.
#[derive(Clone, PartialEq)]
pub struct GridValues {
    points: [usize; 2],
    values: SharedValues,
}

impl GridValues {
    /// The values of `points` = (nx, ny) points. That there are as many, and that they are finite, is checked
    /// where they are used.
    pub fn new(values: impl AsRef<[f64]>, points: [usize; 2]) -> Self {
        GridValues::from_shared(values.as_ref().to_vec(), points)
    }

    /// The same without a copy of the values: a vector, or what somebody else holds too.
    pub fn from_shared(values: impl Into<SharedValues>, points: [usize; 2]) -> Self {
        GridValues {
            points,
            values: values.into(),
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
    pub(crate) fn shared(&self) -> SharedValues {
        self.values.clone()
    }

    /// CRC-32 of the numbers, by which they are told from others.
    pub fn checksum(&self) -> u32 {
        let mut checksum = crc32fast::Hasher::new();
        let mut bytes = [0; SUMMED * size_of::<f64>()];
        for values in self.values.chunks(SUMMED) {
            let (places, _) = bytes.as_chunks_mut();
            for (place, value) in places.iter_mut().zip(values) {
                *place = value.to_le_bytes();
            }
            checksum.update(&bytes[..size_of_val(values)]);
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
