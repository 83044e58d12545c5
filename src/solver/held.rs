//! What a held mean gap asks of a solve besides: a trial scaled back to it, and the mean pressure that it
//! takes.
//!
//! Over a wall the trial is scaled back by linearity (see [`held`](crate::kernel::held)), which takes the
//! pressure of the heights, K h.

use super::contact::ContactSolver;
use crate::backend::{Backend, Field, Level, Spectrum};
use crate::kernel::{Gate, Scalars, common, held, scalar};

/// K h in a field of its own. It is found anew for each load, so that what a step takes does not depend on
/// which steps the same process has done before it.
pub(super) struct HeightsPressure {
    field: Field,
}

impl HeightsPressure {
    /// Plans its field.
    pub fn plan(backend: &mut dyn Backend, level: Level) -> Self {
        HeightsPressure {
            field: backend.field(level, "heights_pressure"),
        }
    }

    /// The field, whatever it holds.
    pub fn field(&self) -> Field {
        self.field
    }

    /// Has the field hold K h; `pressure` is work space, and the scalars are set anew afterwards.
    pub fn find(
        &self,
        backend: &mut dyn Backend,
        [heights, pressure]: [Field; 2],
        stiffness: Spectrum,
    ) {
        // The heights alone: no gap, and no offset, which K takes away and whose rounding it keeps.
        backend.set_scalars(&Scalars::start(0.0, false));
        backend.clear(pressure);
        let level = heights.level;
        backend.forward(&common::LOAD_DISPLACEMENT, level, &[pressure, heights]);
        backend.multiply(stiffness, false, Gate::Always);
        backend.backward(&common::STORE_PRESSURE, level, &[self.field]);
    }
}

impl ContactSolver<'_> {
    /// K h, planned where it is first asked for.
    fn heights_pressure(&mut self) -> Field {
        self.heights_pressure
            .get_or_insert_with(|| HeightsPressure::plan(self.backend, self.level))
            .field()
    }

    /// Whether a trial is scaled back by linearity.
    fn is_linear(&self) -> bool {
        self.kernels.direct.is_none()
    }

    /// Readies what a held mean gap takes, before the scalars of a solve are set.
    pub(super) fn begin_held(&mut self) {
        if self.is_linear() {
            let fields = [self.heights, self.pressure];
            self.heights_pressure
                .get_or_insert_with(|| HeightsPressure::plan(self.backend, self.level))
                .find(self.backend, fields, self.stiffness);
        }
    }

    /// The mean pressure that goes with a held gap.
    pub(super) fn balance(&mut self) {
        if self.params.fixed_gap {
            let fields = [self.gap, self.pressure];
            self.backend
                .sweep(self.kernels.balance, self.level, &fields);
            self.backend.scalar(self.kernels.balance_scalar);
        }
    }

    /// Records the new direction and the trial along it, up to what tells how far it is taken.
    pub(super) fn try_held(&mut self) {
        let (level, kernels) = (self.level, self.kernels);
        let (g, p, d) = (self.gap, self.pressure, self.direction);
        match kernels.direct {
            None => {
                let rigid = self.heights_pressure();
                self.backend
                    .forward(kernels.trial_held, level, &[g, p, rigid, d]);
                self.backend.scalar(kernels.restore);
            }
            Some(direct) => {
                match self.step {
                    Some(step) => self.backend.sweep(direct, level, &[g, d, step]),
                    None => self.backend.sweep(direct, level, &[g, p, d]),
                }
                self.backend.scalar(kernels.restore);
                let moved = self.step.unwrap_or(d);
                self.backend
                    .forward(kernels.trial_held, level, &[g, p, moved]);
            }
        }
        self.backend.scalar(&scalar::ACCEPT);
        self.backend.multiply(self.stiffness, true, Gate::Accepted);
        if self.is_linear() {
            self.backend.scalar(&held::CURVE_WALL);
        }
    }

    /// Records the step, the mean pressure after it and the residual that goes with it.
    pub(super) fn advance_held(&mut self) {
        let (level, kernels) = (self.level, self.kernels);
        let (g, p, before) = (self.gap, self.pressure, self.free_before);
        let moved = self.step.unwrap_or(self.direction);
        match self.is_linear() {
            true => {
                let fields = [moved, self.heights_pressure(), g, p, before];
                self.backend.backward(kernels.advance, level, &fields);
            }
            false => {
                let fields = [moved, g, p, before];
                self.backend.backward(kernels.advance, level, &fields);
            }
        }
        self.backend.scalar(kernels.lengthen);
        self.backend.scalar(kernels.balance_scalar);
        self.ready();
    }
}
