//! Extra work under a prescribed mean gap: a trial brought back to it, and the mean pressure that it takes.
//!
//! Over a unilateral constraint the trial is brought back by linearity (see
//! [`mean_gap`](crate::kernel::mean_gap)), which takes the pressure of the heights, K h.

use super::contact::ContactSolver;
use super::kernel_set::MeanGapTrial;
use crate::backend::{Backend, Field, Level, Spectrum};
use crate::kernel::{Gate, Scalars, displacement, mean_gap, scalar, step_length};

/// K h in a field of its own. It is computed anew for each load, so that a resumed path repeats the work of
/// the original one.
pub(super) struct HeightsPressure {
    field: Field,
}

impl HeightsPressure {
    /// Makes its field.
    pub fn plan(backend: &mut dyn Backend, level: Level) -> Self {
        HeightsPressure {
            field: backend.field(level, "heights_pressure"),
        }
    }

    /// The field.
    pub fn field(&self) -> Field {
        self.field
    }

    /// Computes K h into the field; `pressure` is work space, and the scalars are to be set afterwards.
    pub fn find(
        &self,
        backend: &mut dyn Backend,
        [heights, pressure]: [Field; 2],
        stiffness: Spectrum,
    ) {
        // The heights alone: no gap, and no offset, which K removes but whose rounding would stay.
        backend.set_scalars(&Scalars::start(0.0, false));
        backend.clear(pressure);
        let level = heights.level;
        backend.run(
            &displacement::LOAD_DISPLACEMENT,
            level,
            &[pressure, heights],
        );
        backend.multiply(stiffness, false, Gate::Always);
        backend.run(&displacement::STORE_FIELD, level, &[self.field]);
    }
}

impl ContactSolver<'_> {
    /// K h, made at its first use.
    pub(super) fn heights_pressure(&mut self) -> Field {
        self.heights_pressure
            .get_or_insert_with(|| HeightsPressure::plan(&mut *self.backend, self.level))
            .field()
    }

    /// Prepares a prescribed mean gap, before the scalars of a solve are set.
    pub(super) fn begin_mean_gap(&mut self) {
        if self.kernels.is_linear() {
            let fields = [self.heights, self.pressure];
            self.heights_pressure
                .get_or_insert_with(|| HeightsPressure::plan(&mut *self.backend, self.level))
                .find(&mut *self.backend, fields, self.stiffness);
        }
    }

    /// The mean pressure that a prescribed mean gap takes.
    pub(super) fn balance(&mut self) {
        if self.params.prescribed_mean_gap {
            let fields = [self.gap, self.pressure];
            self.backend
                .run(self.kernels.mean_gap.balance, self.level, &fields);
            self.backend.scalar(&mean_gap::MEAN_PRESSURE);
        }
    }

    /// Records the new direction and the trial along it, up to what tells how far it is taken.
    pub(super) fn try_at_mean_gap(&mut self) {
        let level = self.level;
        let (g, p, d) = (self.gap, self.pressure, self.direction);
        match self.kernels.mean_gap.trial {
            MeanGapTrial::Linear(trial) => {
                let rigid = self.heights_pressure();
                self.backend.run(trial, level, &[g, p, rigid, d]);
                self.backend.scalar(&mean_gap::RESTORE_MEAN_GAP);
            }
            MeanGapTrial::TwoPasses {
                direction,
                load_trial,
            } => {
                match self.step {
                    Some(step) => self.backend.run(direction, level, &[g, d, step]),
                    None => self.backend.run(direction, level, &[g, p, d]),
                }
                self.backend.scalar(&mean_gap::RESTORE_MEAN_GAP);
                let moved = self.step.unwrap_or(d);
                self.backend.run(load_trial, level, &[g, p, moved]);
            }
        }
        self.backend.scalar(&scalar::ACCEPT_TRIAL);
        self.backend.multiply(self.stiffness, true, Gate::Accepted);
        if self.kernels.is_linear() {
            self.backend.scalar(&mean_gap::CURVATURE_BY_LINEARITY);
        }
    }

    /// Records the step, the mean pressure after it and the residual that goes with it.
    pub(super) fn advance_at_mean_gap(&mut self) {
        let (level, advance) = (self.level, self.kernels.mean_gap.advance);
        let (g, p, previous) = (self.gap, self.pressure, self.previous_residual);
        let moved = self.step.unwrap_or(self.direction);
        if self.kernels.is_linear() {
            let fields = [moved, self.heights_pressure(), g, p, previous];
            self.backend.run(advance, level, &fields);
        } else {
            self.backend.run(advance, level, &[moved, g, p, previous]);
        }
        self.backend.scalar(&step_length::ADAPT_TRIAL_LENGTH);
        self.backend.scalar(&mean_gap::MEAN_PRESSURE);
        self.ready();
    }
}
