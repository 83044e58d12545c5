//! The numbers that kernels share: fixed ones, and those that the algorithm moves. Each is declared once,
//! for the processor and for a device.

use super::Sums;
use super::declare::{DeviceValue, FromDevice, Kind, Word, device_struct};
use crate::law::Law;

/// Step lengths that one pass of a search tries where the gap is constrained.
pub const TRIED: usize = 4;

device_struct! {
    /// Numbers that stay fixed during a solve, in reduced units.
    pub struct Params {
        /// The cohesive law; a device has its numbers, and its formulas in WGSL.
        law: Law,
        /// Largest eigenvalue of the stiffness.
        stiffness_max: f64,
        /// Floor of the stopping measure's denominator: `1e-6 E* rms_slope sqrt(points)`.
        pressure_floor: f64,
        /// Largest accepted value of the stopping measure.
        tolerance: f64,
        /// Norm over the surface points of what the gap is rounded beside: of the heights, or of what is
        /// larger.
        heights_norm: f64,
        /// Surface points.
        points: f64,
        /// Stiffness k that a smooth law's change of variable works with.
        smooth_stiffness: f64,
        /// Compliance by which the preconditioner answers the finest waves of a level.
        level_compliance: f64,
        /// That by which the finest level answers the residual at a point itself.
        own_compliance: f64,
        /// And that at each of its four neighbours.
        neighbour_compliance: f64,
        /// Factor a on the slope of an attraction that falls with the gap, in the second sweep of the levels; 0 without one.
        softening: f64,
        /// Largest net pressure that the solid bears, its hardness; infinite for an elastic one.
        hardness: f64,
        /// Relative rounding error of the fields.
        epsilon: f64,
        /// Whether the mean gap is prescribed instead of the mean pressure.
        prescribed_mean_gap: bool,
        /// Whether surfaces may leave each other: mean pressure fixed, no spring, and not pressed.
        may_detach: bool,
    }
}

device_struct! {
    /// The numbers of a law.
    pub struct LawNumbers {
        /// Work of adhesion.
        work: f64,
        /// Its range.
        range: f64,
        /// Its largest tension.
        peak: f64,
        /// Width of a linear end.
        taper: f64,
        /// Gap of the largest tension of a smooth law.
        peak_gap: f64,
        /// Whether the traction varies with the gap where it acts.
        has_tail: bool,
        /// Whether the gap is bounded by a constraint.
        has_wall: bool,
    }
}

impl LawNumbers {
    /// Those of a law.
    pub fn new(law: &Law) -> Self {
        LawNumbers {
            work: law.work_of_adhesion(),
            range: law.range(),
            peak: law.peak_tension(),
            taper: law.taper(),
            peak_gap: law.peak_gap(),
            has_tail: law.has_tail(),
            has_wall: law.has_wall(),
        }
    }
}

impl DeviceValue for Law {
    const KIND: Kind = LawNumbers::KIND;
    fn give(&self, to: &mut dyn FnMut(Word)) {
        LawNumbers::new(self).give(to);
    }
}

/// How a solve stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Status {
    /// Iterating.
    #[default]
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

impl Status {
    /// Each with its name in WGSL; its number there is its place.
    pub const ALL: [(Status, &'static str); 5] = [
        (Status::Running, "RUNNING"),
        (Status::Converged, "CONVERGED"),
        (Status::Stalled, "STALLED"),
        (Status::PulledOff, "PULLED_OFF"),
        (Status::NotFinite, "NOT_FINITE"),
    ];
}

impl DeviceValue for Status {
    const KIND: Kind = Kind::Count;
    fn give(&self, to: &mut dyn FnMut(Word)) {
        (*self as u32).give(to);
    }
}

impl FromDevice for Status {
    /// A number that no shader writes means that memory was not what it should be.
    fn take(from: &mut dyn FnMut(Kind) -> Word) -> Self {
        let place = u32::take(from) as usize;
        Status::ALL
            .get(place)
            .map_or(Status::NotFinite, |&(status, _)| status)
    }
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

device_struct! {
    /// The numbers that the algorithm moves; all of its decisions read and write only these.
    pub struct Scalars and back {
        /// What kernels have summed.
        sums: Sums,
        /// Mean pressure; under a prescribed mean gap its present estimate.
        mean_pressure: f64,
        /// Taken off the displacement before it is transformed: a prescribed mean gap may be large beside
        /// the roughness, and its rounding need not be.
        offset: f64,
        /// Factor of z in the direction: -1, or 0 where a trial is repeated.
        descent_factor: f64,
        /// Factor of the old direction.
        beta: f64,
        /// Constant added to the direction on free points (prescribed mean gap).
        mean_gap_shift: f64,
        /// Trial length a.
        trial_length: f64,
        /// Share of a trial gap that is added to bring it back to the prescribed mean; for a smooth law
        /// the multiple of the local compliance that is taken off.
        mean_gap_correction: f64,
        /// <s, y>, negative for a descent.
        slope: f64,
        /// <s, K s>.
        curvature: f64,
        /// The part of the slope that the elastic pressure makes.
        elastic_slope: f64,
        /// Largest s.
        largest_step: f64,
        /// Least s.
        least_step: f64,
        /// Largest |s|.
        largest_move: f64,
        /// Step length t along s.
        step: f64,
        /// The step length before it was bounded, which sets the next trial length.
        length: f64,
        /// Largest step length before a further point touches.
        first_touch: f64,
        /// Points below this gap are set to zero after a step to first touch; 0 otherwise.
        snap: f64,
        /// Lower end of the search: step length, slope there, and by how much it counts.
        low: [f64; 3],
        /// Upper end of the search, the same; infinite until one is found.
        high: [f64; 3],
        /// Step lengths that the next pass of a search tries where the gap is constrained, rising.
        tried: [f64; TRIED],
        /// End of the search that moved last.
        last_end: f64,
        /// The stopping measure.
        residual: f64,
        /// Its numerator.
        numerator: f64,
        /// Residual at the last stall.
        residual_at_stall: f64,
        /// Least gap over the surface.
        least_gap: f64,
        /// Norm of the gap.
        gap_norm: f64,
        /// How the solve stands.
        status: Status,
        /// Whether the next trial repeats the last direction with a shorter length.
        repeat: bool,
        /// Whether the old direction is forgotten.
        restart: bool,
        /// Whether this iteration's trial was accepted.
        accepted: bool,
        /// Whether the constraint cut the trial at some point.
        cut: bool,
        /// Whether the step length is being searched.
        searching: bool,
        /// Small steps along -z instead of conjugate ones, to stay on the branch of a sharp law.
        careful: bool,
        /// Evaluations in this search; where the gap is constrained, passes.
        evaluations: u32,
        /// Trials lost in a row.
        lost: u32,
        /// Stalls without progress.
        stalls: u32,
        /// Iterations with the numerator at the floor of rounding.
        at_floor: u32,
        /// Iterations so far.
        iterations: u32,
    }
}

impl Scalars {
    /// The state in which a solve starts.
    pub fn start(mean_pressure: f64, careful: bool) -> Self {
        Scalars {
            mean_pressure,
            descent_factor: -1.0,
            trial_length: 1.0,
            high: [f64::INFINITY; 3],
            residual: f64::INFINITY,
            numerator: f64::INFINITY,
            residual_at_stall: f64::INFINITY,
            restart: true,
            careful,
            ..Scalars::default()
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
