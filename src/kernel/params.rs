//! The numbers that kernels share: fixed ones, and those that the algorithm moves.

use crate::law::Law;

/// Sums that one kernel may hand back.
pub const SUMS: usize = 10;
/// Steps that one pass of a search behind a wall looks at.
pub const REACHED: usize = 4;

/// Numbers that stay fixed during a solve, in reduced units.
#[derive(Clone, Copy, Debug)]
pub struct Params {
    /// The cohesive law.
    pub law: Law,
    /// Largest eigenvalue of the stiffness.
    pub stiffness_max: f64,
    /// Floor of the stopping measure's denominator: `1e-6 E* rms_slope sqrt(points)`.
    pub pressure_floor: f64,
    /// Largest accepted value of the stopping measure.
    pub tolerance: f64,
    /// Norm over the surface points of what the gap is rounded beside: of the heights, or of what is larger.
    pub heights_norm: f64,
    /// Whether the mean gap is held instead of the mean pressure.
    pub fixed_gap: bool,
    /// Whether surfaces may leave each other: mean pressure fixed, no spring, and not pressed.
    pub may_detach: bool,
    /// Surface points.
    pub points: f64,
    /// Stiffness that the Lennard-Jones change of variable works with.
    pub core_stiffness: f64,
    /// Largest net pressure that the solid bears before it flows; infinite for an elastic one.
    pub hardness: f64,
    /// Relative rounding error of the fields.
    pub epsilon: f64,
}

/// How a solve stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Iterating.
    Running,
    /// The stopping measure is met.
    Converged,
    /// No step lowers the energy any more.
    Stalled,
    /// The surfaces left each other: no equilibrium carries the load.
    PulledOff,
    /// A number is not finite.
    NotFinite,
}

/// When a kernel runs: it looks at the scalars first, and does nothing where its gate is shut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gate {
    /// Always.
    Always,
    /// While the solve runs.
    Running,
    /// While it runs and the last trial was accepted, so that a new direction is due.
    Fresh,
    /// The same, for what readies a direction and changes no field that outlives it: a device need not
    /// wait for the decisions before it, since one that ends the solve leaves it unread.
    Ahead,
    /// If this iteration's trial was accepted.
    Accepted,
    /// While the step length is being searched; all other gates but `Always` are shut meanwhile.
    Searching,
}

/// The numbers that the algorithm moves; all of its decisions read and write only these.
#[derive(Clone, Copy, Debug)]
pub struct Scalars {
    /// What the last kernel with sums handed back.
    pub sums: [f64; SUMS],
    /// Mean pressure; under a fixed mean gap its present estimate.
    pub mean_pressure: f64,
    /// Taken off the displacement before it is transformed: a held mean gap may be large beside the
    /// roughness, and its rounding need not be.
    pub offset: f64,
    /// Factor of the new descent in the direction: -1, or 0 where a trial is repeated.
    pub descent: f64,
    /// Factor of the old direction.
    pub memory: f64,
    /// Constant added to the direction on free points (fixed mean gap).
    pub shift: f64,
    /// Trial length a.
    pub trial: f64,
    /// Share of a trial gap that is added to bring it back to the held mean; for Lennard-Jones the
    /// multiple of the local compliance that is taken off.
    pub restore: f64,
    /// <s, y>, negative for a descent.
    pub slope: f64,
    /// <s, K s>.
    pub curvature: f64,
    /// The part of the slope that the elastic pressure makes.
    pub elastic_slope: f64,
    /// Of the last step under a held pressure: `<d, yF - old yF>` and `<d, yF>`, d the direction that
    /// it went along.
    pub carried: [f64; 2],
    /// Largest s.
    pub up: f64,
    /// Least s.
    pub down: f64,
    /// Step t along s.
    pub step: f64,
    /// The step before it was bounded, which sets the next trial length.
    pub length: f64,
    /// Largest step before a further point touches.
    pub step_first: f64,
    /// Largest |s|.
    pub largest: f64,
    /// Points below this gap are set to zero after a step to first contact; 0 otherwise.
    pub snap: f64,
    /// Lower end of the search: step, slope and energy there.
    pub low: [f64; 3],
    /// Steps that the next pass of a search behind a wall looks at, rising.
    pub reached: [f64; REACHED],
    /// Upper end of the search: step and slope; infinite while there is none.
    pub high: [f64; 2],
    /// Slope at step 1.
    pub slope_at_one: f64,
    /// The stopping measure.
    pub residual: f64,
    /// Its numerator.
    pub numerator: f64,
    /// Residual at the last stall.
    pub residual_at_stall: f64,
    /// Least gap over the surface.
    pub least_gap: f64,
    /// Norm of the gap.
    pub gap_norm: f64,
    /// How the solve stands.
    pub status: Status,
    /// Whether the next trial repeats the last direction with a shorter length.
    pub repeat: bool,
    /// Whether the old direction is forgotten.
    pub restart: bool,
    /// Whether this iteration's trial was accepted.
    pub accepted: bool,
    /// Whether the trial cut points at the wall.
    pub truncated: bool,
    /// Whether the step length is being searched.
    pub searching: bool,
    /// Small plain steps instead of conjugate ones, to stay on the branch of a sharp law.
    pub careful: bool,
    /// Evaluations in this search; behind a wall, passes.
    pub evaluations: u32,
    /// Trials lost in a row.
    pub lost: u32,
    /// Stalls without progress.
    pub stalls: u32,
    /// Iterations with the numerator at the floor of rounding.
    pub at_floor: u32,
    /// Iterations so far.
    pub iterations: u32,
}

impl Scalars {
    /// The state in which a solve starts.
    pub fn start(mean_pressure: f64, careful: bool) -> Self {
        Scalars {
            sums: [0.0; SUMS],
            mean_pressure,
            offset: 0.0,
            descent: -1.0,
            memory: 0.0,
            shift: 0.0,
            trial: 1.0,
            restore: 0.0,
            slope: 0.0,
            curvature: 0.0,
            elastic_slope: 0.0,
            carried: [0.0; 2],
            up: 0.0,
            down: 0.0,
            step: 0.0,
            length: 0.0,
            step_first: 0.0,
            largest: 0.0,
            snap: 0.0,
            low: [0.0; 3],
            reached: [0.0; REACHED],
            high: [f64::INFINITY; 2],
            slope_at_one: 0.0,
            residual: f64::INFINITY,
            numerator: f64::INFINITY,
            residual_at_stall: f64::INFINITY,
            least_gap: 0.0,
            gap_norm: 0.0,
            status: Status::Running,
            repeat: false,
            restart: true,
            accepted: false,
            truncated: false,
            searching: false,
            careful,
            evaluations: 0,
            lost: 0,
            stalls: 0,
            at_floor: 0,
            iterations: 0,
        }
    }

    /// Whether the solve has ended, or its iteration waits for the end of a search.
    pub fn waits(&self) -> bool {
        self.status != Status::Running || self.searching
    }

    /// Whether a kernel behind this gate runs now.
    pub fn is_open(&self, gate: Gate) -> bool {
        let running = !self.waits();
        match gate {
            Gate::Always => true,
            Gate::Running => running,
            Gate::Fresh | Gate::Ahead => running && !self.repeat,
            Gate::Accepted => running && self.accepted,
            Gate::Searching => self.status == Status::Running && self.searching,
        }
    }
}
