//! What a solve is asked, from which state it starts, and how it ended.

use crate::backend::long_field::LongField;
use crate::kernel::Status;

/// What is prescribed, reduced units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hold {
    /// The mean pressure over all solved points.
    Pressure(f64),
    /// The mean gap (periodic grids).
    Gap(f64),
}

/// A load: what is prescribed, and the stiffness of a spring on the mean displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// What is prescribed.
    pub hold: Hold,
    /// Stiffness of the zero mode: 0 without a spring, and where the mean gap is held.
    pub zero_stiffness: f64,
    /// The preconditioner's zero mode, a compliance.
    pub zero_compliance: f64,
}

/// The state from which a solve starts.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// The gap in the solver's field as it is.
    Present,
    /// This gap over all solved points; pressures are evaluated from it.
    Gap(LongField<f64>),
    /// The undeformed heights at first touch, helped by coarser grids where that pays.
    Cold,
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Converged, stalled, pulled off, not finite; `Running` where the iterations ran out.
    pub status: Status,
    /// Iterations.
    pub iterations: usize,
    /// The stopping measure, evaluated afresh from the final gap.
    pub residual: f64,
    /// Mean pressure over all solved points, reduced, without the zero mode's share.
    pub mean_pressure: f64,
}

impl Outcome {
    /// The end of a solve, with the residual and the mean pressure of its last evaluation. Without a finite
    /// residual it has not converged, whatever the iterations say.
    pub(super) fn new(
        status: Status,
        iterations: usize,
        residual: f64,
        mean_pressure: f64,
    ) -> Outcome {
        let status = match status {
            Status::Converged if !residual.is_finite() => Status::Stalled,
            status => status,
        };
        Outcome {
            status,
            iterations,
            residual,
            mean_pressure,
        }
    }
}
