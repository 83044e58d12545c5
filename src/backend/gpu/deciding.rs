//! Scalar kernels and the final sums that they need, run between field kernels in one dispatch.
//!
//! They are recorded when a kernel needs their result. Kernels and products that run before then write their
//! partial sums to separate places, which the next such dispatch adds up.

use super::bindings::DECIDING;
use super::level::Place;
use super::source::{self, Decision, Reduction};
use super::space::{self, Key};
use super::{GpuBackend, GpuError};
use crate::backend::Level;
use crate::kernel::ScalarKernel;

/// Sums and scalar kernels of one dispatch, in this order.
#[derive(Default)]
pub(super) struct Deciding {
    parts: Vec<Part>,
}

enum Part {
    Sums(Decided),
    Scalar(&'static ScalarKernel),
}

/// Partial sums to add up.
pub(super) struct Decided {
    /// Their place on their level.
    pub of: space::Decided,
    pub level: Level,
    pub place: Place,
    pub reduction: Reduction,
}

impl Deciding {
    pub fn decide(&mut self, kernel: &'static ScalarKernel) {
        self.parts.push(Part::Scalar(kernel));
    }

    /// Whether partial sums in this place on this level may wait beside those already waiting.
    fn has_room(&self, level: Level, place: Place) -> bool {
        self.parts.iter().all(|part| match part {
            Part::Sums(sums) => sums.level == level && sums.place != place,
            Part::Scalar(_) => true,
        })
    }
}

impl GpuBackend {
    /// Records the waiting work if partial sums in this place cannot wait beside it.
    pub(super) fn make_room(&mut self, level: Level, place: Place) -> Result<(), GpuError> {
        match self.deciding.has_room(level, place) {
            true => Ok(()),
            false => self.settle(),
        }
    }

    /// Adds partial sums to those that wait.
    pub(super) fn put_off(&mut self, sums: Decided) {
        self.deciding.parts.push(Part::Sums(sums));
    }

    /// Records the waiting work.
    pub(super) fn settle(&mut self) -> Result<(), GpuError> {
        if self.deciding.parts.is_empty() {
            return Ok(());
        }
        let Deciding { parts } = std::mem::take(&mut self.deciding);
        let mut names = Vec::with_capacity(parts.len());
        let mut level = Level(0);
        for part in &parts {
            names.push(match part {
                Part::Scalar(kernel) => {
                    let place = std::ptr::from_ref(*kernel).addr();
                    (space::Decided::Kernel(place), None)
                }
                Part::Sums(sums) => {
                    level = sums.level;
                    (sums.of, Some(sums.level.0))
                }
            });
        }
        self.dispatch(Key::Decide(names), |backend| {
            let decisions: Vec<_> = parts
                .iter()
                .map(|part| match part {
                    Part::Scalar(kernel) => Decision::Scalar(kernel),
                    Part::Sums(sums) => Decision::Sums(sums.reduction),
                })
                .collect();
            let text = source::decide(&decisions, backend.wide, backend.device.loops())?;
            let space = backend.level_space(level)?;
            let shared = [&backend.params, &backend.scalars, &space.partials];
            let prepared = backend.prepare("decide", text, &[(DECIDING, &shared)], [1, 1])?;
            Ok(vec![prepared])
        })
    }
}
