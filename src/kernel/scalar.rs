//! Scalar kernels: every decision of the algorithm, on the [`Scalars`] alone. Their twins in WGSL have the
//! same text, function for function.

use crate::kernel::{Params, Scalars, Status};

/// One scalar kernel of the catalogue.
pub struct ScalarKernel {
    /// The word under which it is found everywhere.
    pub name: &'static str,
    /// What it does.
    pub run: fn(&Params, &mut Scalars),
}

macro_rules! scalar_kernel {
    ($(#[$doc:meta])* $constant:ident, $run:ident) => {
        $(#[$doc])*
        pub static $constant: $crate::kernel::ScalarKernel =
            $crate::kernel::ScalarKernel { name: stringify!($run), run: $run };
    };
}
pub(super) use scalar_kernel;

/// Declares constants of the decisions, once for Rust and once for WGSL.
macro_rules! constants {
    ($(#[$list:meta])* $wgsl:ident: $($(#[$doc:meta])* $name:ident: $kind:ident = $value:literal,)*) => {
        $($(#[$doc])* pub(crate) const $name: constants!(@rust $kind) = $value;)*
        $(#[$list])*
        #[cfg(feature = "gpu")]
        pub(crate) const $wgsl: &str =
            concat!($("const ", stringify!($name), ": ", stringify!($kind), " = ", stringify!($value), ";\n"),*);
    };
    (@rust wide) => { f64 };
    (@rust u32) => { u32 };
}

constants! {
    /// The same in WGSL.
    CONSTANTS:
    /// Trials that may be lost in a row before the direction is given up.
    LOST_TRIALS: u32 = 25,
    /// Lost trials after which the plain descent takes the direction's place.
    LOST_BEFORE_DESCENT: u32 = 5,
    /// Factor on the trial length after a lost trial.
    SHORTEN: wide = 0.3,
    /// Stalls without progress that end a solve.
    STALLS: u32 = 4,
    /// Iterations at the floor of rounding that end a solve.
    AT_FLOOR: u32 = 20,
    /// A direction whose slope is above this share of the descent's is given up.
    SLOPE_SHARE: wide = 1e-6,
    /// Curvature over slope below which a step is a rigid motion.
    RIGID: wide = 1e-30,
    /// Roundings within which all points of a step go the same way.
    SAME_WAY: wide = 16.0,
    /// Ranges beyond which surfaces under tension have left each other.
    DETACHED_RANGES: wide = 60.0,
    /// The rounding floor of the numerator over `epsilon K_max norm(h or g)`: a gap rounded once leaves
    /// 0.15 of it, one rounded in each of some twenty steps up to 0.7, and the transforms of fresh pressures on
    /// 48 x 48 points up to 1.75.
    FLOOR_FACTOR: wide = 2.0,
    /// Gaps below this share of the largest step are closed by a step to first touch.
    LEAST_SNAP: wide = 1e-12,
    /// The same in relative rounding errors of the fields, where these are larger.
    SNAP_ROUNDINGS: wide = 8.0,
    /// Step along the plain descent in careful mode.
    CAREFUL_LENGTH: wide = 0.25,
    /// Residual at which careful mode ends.
    CAREFUL_UNTIL: wide = 1e-3,
    /// Iterations after which careful mode ends all the same. Under a load that nearly lets go it crawls, long
    /// after the points within the range have been chosen: on 200 rough surfaces each of the 1 % of steps that
    /// took more came to the same points with this bound as without one, and with 300 all but five steps did.
    CAREFUL_MOST: u32 = 2000,
    /// Majorant step from which a cut trial is taken whole.
    WHOLE_STEP: wide = 0.6,
    /// Share of the first slope at which a search ends.
    SEARCH_SHARE: wide = 0.1,
    /// Step lengths that a pass of a search tries, over the first one: up to five times the step that the
    /// energy without attraction asks for, close enough to each other that one of them is near the best.
    SECOND_REACH: wide = 1.75,
    /// The third.
    THIRD_REACH: wide = 3.0,
    /// The fourth.
    FOURTH_REACH: wide = 5.0,
    /// Extrapolations, or passes, that one search may make.
    EXTRAPOLATIONS: u32 = 6,
    /// Evaluations that one bracket may take.
    EVALUATIONS: u32 = 40,
    /// The lower end of a bracket.
    LOWER_END: wide = -1.0,
    /// The upper one.
    UPPER_END: wide = 1.0,
    /// Roundings of what they are taken from within which the parts of s cancel each other.
    VANISHES: wide = 8.0,
}

/// The floor that rounding sets to the numerator of the stopping measure.
pub fn rounding_floor(params: &Params, scalars: &Scalars) -> f64 {
    FLOOR_FACTOR * params.epsilon * params.stiffness_max * params.heights_norm.max(scalars.gap_norm)
}

/// The quotient with 0/0 = 0 and x/0 infinite.
pub(super) fn quotient(numerator: f64, denominator: f64) -> f64 {
    if numerator == 0.0 {
        0.0
    } else {
        numerator / denominator
    }
}

pub(super) fn give_up_direction(scalars: &mut Scalars) {
    scalars.beta = 0.0;
    scalars.trial_length = 1.0;
    scalars.lost = 0;
    scalars.repeat = false;
    scalars.restart = true;
}

pub(super) fn stall(scalars: &mut Scalars) {
    give_up_direction(scalars);
    if scalars.residual < 0.5 * scalars.residual_at_stall {
        scalars.stalls = 0;
    }
    scalars.residual_at_stall = scalars.residual;
    scalars.stalls += 1;
    if scalars.stalls >= STALLS {
        scalars.status = Status::Stalled;
    }
}

fn test_convergence(params: &Params, scalars: &mut Scalars) {
    // After a lost trial the state is the one that was tested.
    if scalars.waits() || scalars.lost > 0 {
        return;
    }
    let sums = scalars.sums;
    scalars.numerator = sums.violation.sqrt();
    scalars.least_gap = sums.least_gap;
    scalars.gap_norm = sums.gap_squares.sqrt();
    let pressures_norm = sums.pressures.sqrt();
    let floor = rounding_floor(params, scalars);
    // Between flat surfaces there may be no pressure at all. 0/0 counts as 0, and what rounding alone has left of
    // either is 0: nothing is gained by going on, and a direction made of rounding leads anywhere.
    // Surfaces that part are not at rest, however far the rounding of their gap reaches by then.
    let detached = params.may_detach && sums.least_gap > DETACHED_RANGES * params.law.range();
    let nothing = params.pressure_floor == 0.0 && pressures_norm <= floor && !detached;
    scalars.residual = if nothing && scalars.numerator <= floor {
        0.0
    } else {
        quotient(scalars.numerator, pressures_norm.max(params.pressure_floor))
    };
    let finite = [sums.violation, sums.pressures, sums.gap_squares];
    if finite.into_iter().any(|sum| !sum.is_finite()) {
        scalars.status = Status::NotFinite;
    } else if scalars.residual <= params.tolerance {
        scalars.status = Status::Converged;
    } else if detached {
        scalars.status = Status::PulledOff;
    } else if scalars.numerator <= floor {
        scalars.at_floor += 1;
        if scalars.at_floor >= AT_FLOOR {
            scalars.status = Status::Stalled;
        }
    } else {
        scalars.at_floor = 0;
    }
    // Beyond the range of a sharp law nothing attracts: under tension there is no way back, and else not if all
    // steps still to come, a geometric series, do not lead there.
    let beyond = sums.least_gap - params.law.range();
    let way_left = scalars.largest_move / CAREFUL_LENGTH;
    let separated = beyond > 0.0 && (params.may_detach || (scalars.accepted && way_left < beyond));
    let careful_enough = scalars.residual < CAREFUL_UNTIL || scalars.iterations >= CAREFUL_MOST;
    if scalars.careful && (separated || careful_enough) {
        scalars.careful = false;
        give_up_direction(scalars);
    }
}
scalar_kernel!(
    /// Step 1, `plain::state`: the stopping measure from its sums, and what follows
    /// from it.
    TEST_CONVERGENCE, test_convergence
);

fn conjugate_direction(params: &Params, scalars: &mut Scalars) {
    if scalars.waits() || scalars.repeat {
        return;
    }
    let sums = scalars.sums;
    // Under a prescribed mean gap z and d carry no mean over the free points (in the measure of the
    // local compliance, for a smooth law).
    let (mut z_mean, mut d_mean, mut residual_sum, mut change_sum) = (0.0, 0.0, 0.0, 0.0);
    if params.prescribed_mean_gap {
        z_mean = quotient(sums.weighted_z, sums.free_weight);
        d_mean = quotient(sums.weighted_direction, sums.free_weight);
        residual_sum = sums.free_residual;
        change_sum = sums.free_change;
    }
    let z_residual = sums.z_residual - z_mean * residual_sum;
    let z_change = sums.z_change - z_mean * change_sum;
    let mut beta = 0.0;
    if sums.direction_change > 0.0 {
        beta = (z_change / sums.direction_change).max(0.0);
    }
    if scalars.restart || scalars.careful || !beta.is_finite() {
        beta = 0.0;
    }
    scalars.restart = false;
    let slope = -z_residual + beta * (sums.direction_residual - d_mean * residual_sum);
    if slope >= -SLOPE_SHARE * z_residual {
        beta = 0.0;
    }
    scalars.descent_factor = -1.0;
    scalars.beta = beta;
    scalars.mean_gap_shift = z_mean - beta * d_mean;
    if scalars.careful {
        scalars.trial_length = CAREFUL_LENGTH;
    }
}
scalar_kernel!(
    /// Step 3: beta of the conjugate direction (Polak-Ribiere, never negative).
    CONJUGATE_DIRECTION, conjugate_direction
);

fn accept_trial(_: &Params, scalars: &mut Scalars) {
    if scalars.waits() {
        return;
    }
    scalars.accepted = false;
    let sums = scalars.sums;
    if !sums.slope.is_finite() {
        scalars.status = Status::NotFinite;
        return;
    }
    scalars.slope = sums.slope;
    scalars.elastic_slope = sums.elastic_slope;
    scalars.first_touch = sums.first_touch.max(1.0);
    scalars.largest_step = sums.largest_step;
    scalars.least_step = sums.least_step;
    scalars.largest_move = sums.largest_step.max(-sums.least_step);
    scalars.cut = sums.cut > 0.0;
    if sums.slope < 0.0 || (scalars.careful && scalars.largest_move > 0.0) {
        scalars.accepted = true;
        scalars.repeat = false;
        scalars.lost = 0;
        scalars.iterations += 1;
        return;
    }
    scalars.lost += 1;
    if scalars.lost >= LOST_TRIALS || scalars.largest_move == 0.0 {
        stall(scalars);
        return;
    }
    scalars.trial_length *= SHORTEN;
    // The trial has taken the place of the descent, which is found again where it is wanted.
    scalars.restart = scalars.lost == LOST_BEFORE_DESCENT;
    scalars.repeat = !scalars.restart;
    scalars.descent_factor = 0.0;
    scalars.beta = 1.0;
    scalars.mean_gap_shift = 0.0;
}
scalar_kernel!(
    /// Step 4: takes a trial that descends; otherwise shortens it and has it repeated.
    ACCEPT_TRIAL, accept_trial
);
