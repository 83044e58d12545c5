//! The elastic operator on values of the host, between solves.

use super::contact::ContactSolver;
use crate::backend::long_field::LongField;
use crate::backend::{BackendError, Spectrum};
use crate::grid::Boundary;
use crate::kernel::{Gate, displacement};

impl ContactSolver<'_> {
    /// `<values, K*values>/2` over all solved points, reduced: the elastic energy of a displacement.
    /// Between solves only: it uses their directions as work space.
    pub fn energy_of(&mut self, values: &[f64]) -> Result<f64, BackendError> {
        let own = self.own_zero_mode();
        if let Some(outer) = &mut self.outer {
            return outer.energy_of(&self.problem.share, values, own);
        }
        let pressure = self.stiffness_times(values)?;
        Ok(0.5 * self.problem.share.product(values, &pressure))
    }

    /// A free half-space's own zero mode; a load's is not elastic.
    fn own_zero_mode(&self) -> f64 {
        match self.problem.boundary {
            Boundary::Periodic => 0.0,
            Boundary::Free => self.problem.stiffness.zero_mode(),
        }
    }

    /// `K*values` over all solved points, reduced, with the half-space's own zero mode. Between
    /// solves only: it uses their directions as work space.
    pub(super) fn stiffness_times(
        &mut self,
        values: &[f64],
    ) -> Result<LongField<f64>, BackendError> {
        let own = self.own_zero_mode();
        self.backend.set_zero_mode(self.stiffness, own);
        self.convolve(self.stiffness, values)
    }

    /// `S*values`, S the inverse of that stiffness; 0 for a problem without conductance.
    pub(super) fn compliance_times(
        &mut self,
        values: &[f64],
    ) -> Result<LongField<f64>, BackendError> {
        match self.compliance {
            Some(compliance) => self.convolve(compliance, values),
            None => Ok(LongField::zeros(values.len())),
        }
    }

    fn convolve(&mut self, by: Spectrum, values: &[f64]) -> Result<LongField<f64>, BackendError> {
        let work = self.direction;
        self.backend.write(work, values);
        self.backend
            .run(&displacement::LOAD_FIELD, self.level, &[work]);
        self.backend.multiply(by, false, Gate::Always);
        self.backend
            .run(&displacement::STORE_FIELD, self.level, &[work]);
        self.backend.read(work)
    }
}
