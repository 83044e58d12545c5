//! Decisions between two kernels over points: sums put together and scalar kernels, in one dispatch.

use super::bindings::DECIDING;
use super::source::{self, Reduction};
use super::space::Key;
use super::{GpuBackend, GpuError};
use crate::backend::Level;
use crate::kernel::ScalarKernel;

/// What is decided together: the sums of the last kernel over points, then scalar kernels.
#[derive(Default)]
pub(super) struct Deciding {
    pub reduction: Option<Decided>,
    pub kernels: Vec<&'static ScalarKernel>,
}

/// Sums to be put together.
pub(super) struct Decided {
    /// What they are known by on their level.
    pub name: &'static str,
    pub level: Level,
    pub reduction: Reduction,
}

impl GpuBackend {
    /// Records what waits to be decided.
    pub(super) fn settle(&mut self) -> Result<(), GpuError> {
        if self.deciding.reduction.is_none() && self.deciding.kernels.is_empty() {
            return Ok(());
        }
        let Deciding { reduction, kernels } = std::mem::take(&mut self.deciding);
        let key = Key::Decide(
            reduction.as_ref().map(|sums| (sums.name, sums.level.0)),
            kernels.iter().map(|kernel| kernel.name).collect(),
        );
        self.dispatch(key, |backend| {
            let level = reduction.as_ref().map_or(Level(0), |sums| sums.level);
            let first = reduction.as_ref().map(|sums| sums.reduction);
            let text = source::decide(first, &kernels, backend.wide)?;
            let space = backend.level_space(level)?;
            let shared = [&backend.params, &backend.scalars, &space.partials];
            let prepared = backend.prepare("decide", text, &[(DECIDING, &shared)], 1)?;
            Ok(vec![prepared])
        })
    }
}
