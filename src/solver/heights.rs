//! Heights of a problem, which it shares with the surface that they come from.

use crate::backend::Share;
use crate::grid::Grid;
use crate::shared_values::SharedValues;

/// Heights on the grid in reduced units, worked out from those in metres as they are read: a second field would
/// hold the same.
#[derive(Clone, Debug)]
pub struct Heights {
    /// Of the held rows; `None` of a sketch.
    metres: Option<SharedValues>,
    /// What is taken off, m.
    origin: f64,
    /// A reduced unit, m.
    unit: f64,
    /// The lowest and the highest of the whole grid, reduced.
    ends: [f64; 2],
    /// Their root mean square about their mean.
    rms: f64,
    /// Their norm.
    norm: f64,
}

impl Heights {
    /// Heights of the held rows of a grid in metres less `origin`, in units of `unit`.
    pub fn new(
        metres: SharedValues,
        origin: f64,
        unit: f64,
        share: &Share,
        grid: &Grid,
    ) -> Heights {
        let reduced = |h: f64| (h - origin) / unit;
        let count = grid.len() as f64;
        let mean = share.surface_sum_by(&metres, reduced) / count;
        let square = share.surface_sum_by(&metres, |h| {
            let deviation = reduced(h) - mean;
            deviation * deviation
        });
        let norm = share.surface_sum_by(&metres, |h| reduced(h) * reduced(h));
        // A shift and a scale keep the order.
        let ends = [share.least_of(&metres), share.greatest_of(&metres)];
        Heights {
            metres: Some(metres),
            origin,
            unit,
            ends: ends.map(reduced),
            rms: (square / count).sqrt(),
            norm: norm.sqrt(),
        }
    }

    /// No heights, of a sketch.
    pub fn none() -> Heights {
        Heights {
            metres: None,
            origin: 0.0,
            unit: 1.0,
            ends: [0.0; 2],
            rms: 0.0,
            norm: 0.0,
        }
    }

    fn held(&self) -> &[f64] {
        self.metres.as_ref().map_or(&[], SharedValues::as_slice)
    }

    /// The height at each held grid point, reduced.
    pub fn by_point(&self) -> impl Fn(usize) -> f64 + Sync + '_ {
        let metres = self.held();
        move |point| (metres[point] - self.origin) / self.unit
    }

    /// The height at each point of a held row of so many grid points, reduced; none beyond its end, or of a row beyond the last.
    pub fn row(&self, row: usize, width: usize) -> impl Fn(usize) -> Option<f64> + '_ {
        let metres = self.held().chunks_exact(width).nth(row).unwrap_or_default();
        move |x| metres.get(x).map(|h| (h - self.origin) / self.unit)
    }

    /// Those held, row by row, reduced.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = f64> + '_ {
        self.held().iter().map(|h| (h - self.origin) / self.unit)
    }

    /// How many are held.
    pub fn len(&self) -> usize {
        self.held().len()
    }

    /// Whether none are held.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether they are those of a sketch.
    pub fn are_none(&self) -> bool {
        self.metres.is_none()
    }

    /// The lowest of the whole grid, as sampled, reduced.
    pub fn lowest(&self) -> f64 {
        self.ends[0]
    }

    /// The highest of the whole grid, as sampled, reduced.
    pub fn highest(&self) -> f64 {
        self.ends[1]
    }

    /// Root mean square about their mean over the whole grid, reduced.
    pub fn rms(&self) -> f64 {
        self.rms
    }

    /// Root of the sum of their squares over the whole grid, reduced.
    pub fn norm(&self) -> f64 {
        self.norm
    }
}
