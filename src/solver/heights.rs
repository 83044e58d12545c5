//! Heights of a problem, which it shares with the surface that they come from.

use crate::shared_values::SharedValues;

/// Heights on the grid in reduced units, worked out from those in metres as they are read: a second field would
/// hold the same.
#[derive(Clone, Debug)]
pub struct Heights {
    metres: SharedValues,
    /// What is taken off, m.
    origin: f64,
    /// A reduced unit, m.
    unit: f64,
}

impl Heights {
    /// Heights in metres less `origin`, in units of `unit`.
    pub fn new(metres: SharedValues, origin: f64, unit: f64) -> Heights {
        Heights {
            metres,
            origin,
            unit,
        }
    }

    /// Heights that are reduced already.
    pub fn from_reduced(values: Vec<f64>) -> Heights {
        Heights::new(values.into(), 0.0, 1.0)
    }

    /// The height at each grid point, reduced.
    pub fn by_point(&self) -> impl Fn(usize) -> f64 + '_ {
        let metres = self.metres.as_slice();
        move |point| (metres[point] - self.origin) / self.unit
    }

    /// All of them, row by row, reduced.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.metres.iter().map(|h| (h - self.origin) / self.unit)
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.metres.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.metres.is_empty()
    }

    /// The highest, as sampled, reduced.
    pub fn highest(&self) -> f64 {
        self.iter().fold(f64::NEG_INFINITY, f64::max)
    }
}
