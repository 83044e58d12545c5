//! Scalar kernels: every decision of the algorithm, on the [`Scalars`] alone.
//!
//! Slots of `sums` are those that the kernels before them fill.

use crate::kernel::{Params, REACHED, Scalars, Status};

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
        pub static $constant: ScalarKernel = ScalarKernel { name: stringify!($run), run: $run };
    };
}
pub(super) use scalar_kernel;

/// Trials that may be lost in a row before the direction is given up.
const LOST_TRIALS: u32 = 25;
/// Lost trials after which the plain descent takes the direction's place.
const LOST_BEFORE_DESCENT: u32 = 5;
/// Factor on the trial length after a lost trial.
const SHORTEN: f64 = 0.3;
/// Stalls without progress that end a solve.
const STALLS: u32 = 4;
/// Iterations at the floor of rounding that end a solve.
const AT_FLOOR: u32 = 20;
/// A direction whose slope is above this share of the descent's is given up.
const SLOPE_SHARE: f64 = 1e-6;
/// Curvature over slope below which a step is a rigid motion.
const RIGID: f64 = 1e-30;
/// Roundings within which all points of a step go the same way.
const SAME_WAY: f64 = 16.0;
/// Ranges beyond which surfaces under tension have left each other.
const DETACHED_RANGES: f64 = 60.0;
/// The rounding floor of the numerator over `epsilon K_max norm(h or g)`: a gap rounded once leaves
/// 0.15 of it, one rounded in each of some twenty steps up to 0.7.
const FLOOR_FACTOR: f64 = 1.0;
/// Gaps below this share of the largest step are closed by a step to first contact.
pub const LEAST_SNAP: f64 = 1e-12;
/// The same in relative rounding errors of the fields, where these are larger.
pub const SNAP_ROUNDINGS: f64 = 8.0;
/// Step along the plain descent in careful mode.
const CAREFUL_LENGTH: f64 = 0.25;
/// Residual at which careful mode ends.
const CAREFUL_UNTIL: f64 = 1e-3;
/// Iterations after which careful mode ends all the same. Under a load that nearly lets go it crawls, long
/// after the points within the range have been chosen: on 200 rough surfaces each of the 1 % of steps that
/// took more came to the same points with this bound as without one, and with 300 all but five steps did.
const CAREFUL_MOST: u32 = 2000;
/// Share of the first slope at which a search ends.
const SEARCH_SHARE: f64 = 0.1;
/// Steps that a pass of a search behind a wall looks at, over the first one: up to five times the step that
/// the energy without attraction asks for, close enough to each other that one of them is near the best.
const REACHES: [f64; REACHED] = [1.0, 1.75, 3.0, 5.0];
/// Extrapolations, or passes, that one search may make.
const EXTRAPOLATIONS: u32 = 6;
/// Evaluations that one Lennard-Jones search may make.
const EVALUATIONS: u32 = 40;
/// First of the sums in which a Lennard-Jones trial evaluates the step 1, as a search would.
const AT_ONE: usize = 6;

/// The floor that rounding sets to the numerator of the stopping measure.
pub fn rounding_floor(params: &Params, scalars: &Scalars) -> f64 {
    FLOOR_FACTOR * params.epsilon * params.stiffness_max * params.heights_norm.max(scalars.gap_norm)
}

/// The quotient with 0/0 = 0 and x/0 infinite.
fn quotient(numerator: f64, denominator: f64) -> f64 {
    if numerator == 0.0 {
        0.0
    } else {
        numerator / denominator
    }
}

fn give_up_direction(scalars: &mut Scalars) {
    scalars.memory = 0.0;
    scalars.trial = 1.0;
    scalars.lost = 0;
    scalars.repeat = false;
    scalars.restart = true;
}

fn stall(scalars: &mut Scalars) {
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

fn judge(params: &Params, scalars: &mut Scalars) {
    // After a lost trial the state is the one that was judged.
    if scalars.waits() || scalars.lost > 0 {
        return;
    }
    let [violation, pressures, least_gap, gaps, ..] = scalars.sums;
    scalars.numerator = violation.sqrt();
    scalars.least_gap = least_gap;
    scalars.gap_norm = gaps.sqrt();
    let pressures_norm = pressures.sqrt();
    let floor = rounding_floor(params, scalars);
    // Between flat surfaces there may be no pressure at all. 0/0 counts as 0, and what rounding alone has left of
    // either is 0: nothing is gained by going on, and a direction made of rounding leads anywhere.
    // What is on its way apart is not at rest, however far the rounding of its gap reaches by then.
    let detached = params.may_detach && least_gap > DETACHED_RANGES * params.law.range();
    let nothing = params.pressure_floor == 0.0 && pressures_norm <= floor && !detached;
    scalars.residual = if nothing && scalars.numerator <= floor {
        0.0
    } else {
        quotient(scalars.numerator, pressures_norm.max(params.pressure_floor))
    };
    if !violation.is_finite() || !pressures.is_finite() || !gaps.is_finite() {
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
    // Beyond the range of a sharp law nothing sticks: under tension there is no way back, and else not if all
    // that is left of the way, a geometric series of steps like the last, does not lead there.
    let beyond = least_gap - params.law.range();
    let way_left = scalars.largest / CAREFUL_LENGTH;
    let apart = beyond > 0.0 && (params.may_detach || (scalars.accepted && way_left < beyond));
    let careful_enough = scalars.residual < CAREFUL_UNTIL || scalars.iterations >= CAREFUL_MOST;
    if scalars.careful && (apart || careful_enough) {
        scalars.careful = false;
        give_up_direction(scalars);
    }
}
scalar_kernel!(
    /// The stopping measure from its sums, and what follows from it.
    JUDGE, judge
);

fn carry(_: &Params, scalars: &mut Scalars) {
    if !scalars.waits() {
        scalars.carried = [scalars.sums[4], scalars.sums[5]];
    }
}
scalar_kernel!(
    /// Keeps what the last step says of its direction.
    CARRY, carry
);

fn direct(params: &Params, scalars: &mut Scalars) {
    if scalars.waits() || scalars.repeat {
        return;
    }
    let [
        zy,
        z_change,
        d_change,
        dy,
        z_sum,
        weight,
        y_sum,
        change_sum,
        d_sum,
        ..,
    ] = scalars.sums;
    // Which points are free is known only after the mean pressure where that follows from the gap.
    let [d_change, dy] = match params.fixed_gap {
        true => [d_change, dy],
        false => scalars.carried,
    };
    // Under a held mean gap z and d carry no mean over the free points (in the measure of the
    // local compliance, for Lennard-Jones).
    let z_mean = if params.fixed_gap {
        quotient(z_sum, weight)
    } else {
        0.0
    };
    let zy = zy - z_mean * y_sum;
    let z_change = z_change - z_mean * change_sum;
    let mut memory = if d_change > 0.0 {
        (z_change / d_change).max(0.0)
    } else {
        0.0
    };
    if scalars.restart || scalars.careful || !memory.is_finite() {
        memory = 0.0;
    }
    scalars.restart = false;
    let d_mean = if params.fixed_gap {
        quotient(d_sum, weight)
    } else {
        0.0
    };
    let slope = -zy + memory * (dy - d_mean * y_sum);
    if slope >= -SLOPE_SHARE * zy {
        memory = 0.0;
    }
    scalars.descent = -1.0;
    scalars.memory = memory;
    scalars.shift = z_mean - memory * d_mean;
    if scalars.careful {
        scalars.trial = CAREFUL_LENGTH;
    }
}
scalar_kernel!(
    /// The conjugacy of the new direction (Polak-Ribiere, never negative).
    DIRECT, direct
);

fn restore_yield(_: &Params, scalars: &mut Scalars) {
    if scalars.waits() {
        return;
    }
    let [step, present, depth, ..] = scalars.sums;
    let size = present + step + 2.0 * depth;
    scalars.restore = if size > 0.0 { -step / size } else { 0.0 };
}
scalar_kernel!(
    /// The share of a trial gap that brings it back to the held mean; gaps below zero are scaled the other
    /// way.
    RESTORE_YIELD, restore_yield
);

fn restore_core(params: &Params, scalars: &mut Scalars) {
    if scalars.waits() {
        return;
    }
    let [step, share, ..] = scalars.sums;
    scalars.restore = if params.fixed_gap {
        quotient(step, share)
    } else {
        0.0
    };
}
scalar_kernel!(
    /// The multiple of the local compliance that keeps the mean of a step zero.
    RESTORE_CORE, restore_core
);

fn accept(_: &Params, scalars: &mut Scalars) {
    if scalars.waits() {
        return;
    }
    scalars.accepted = false;
    let [slope, first, up, down, cut, elastic, ..] = scalars.sums;
    if !slope.is_finite() {
        scalars.status = Status::NotFinite;
        return;
    }
    scalars.slope = slope;
    scalars.elastic_slope = elastic;
    scalars.step_first = first.max(1.0);
    scalars.up = up;
    scalars.down = down;
    scalars.largest = up.max(-down);
    scalars.truncated = cut > 0.0;
    if slope < 0.0 || (scalars.careful && scalars.largest > 0.0) {
        scalars.accepted = true;
        scalars.repeat = false;
        scalars.lost = 0;
        scalars.iterations += 1;
        return;
    }
    scalars.lost += 1;
    if scalars.lost >= LOST_TRIALS || scalars.largest == 0.0 {
        stall(scalars);
        return;
    }
    scalars.trial *= SHORTEN;
    // The trial has taken the place of the descent, which is found again where it is wanted.
    scalars.restart = scalars.lost == LOST_BEFORE_DESCENT;
    scalars.repeat = !scalars.restart;
    scalars.descent = 0.0;
    scalars.memory = 1.0;
    scalars.shift = 0.0;
}
scalar_kernel!(
    /// Takes a trial that descends; otherwise shortens it and has it repeated.
    ACCEPT, accept
);

/// Whether the accepted step is a rigid motion; then says what becomes of it. A mean gap that is held leaves
/// none: what looks like one is rounding.
fn rigid_motion(params: &Params, scalars: &mut Scalars) -> bool {
    if scalars.curvature > RIGID * scalars.slope.abs() {
        return false;
    }
    if !scalars.curvature.is_finite() {
        scalars.status = Status::NotFinite;
    } else if scalars.down > 0.0 && params.may_detach {
        scalars.status = Status::PulledOff;
    } else if scalars.up < 0.0 && scalars.step_first.is_finite() && !params.fixed_gap {
        scalars.step = scalars.step_first;
        scalars.length = scalars.step;
        return true;
    } else {
        scalars.accepted = false;
        stall(scalars);
    }
    true
}

/// Whether a step lifts all points by the same way.
fn is_rigid_lift(params: &Params, scalars: &Scalars) -> bool {
    scalars.down > 0.0 && scalars.up - scalars.down <= SAME_WAY * params.epsilon * scalars.up
}

fn step_wall(params: &Params, scalars: &mut Scalars) {
    if scalars.waits() || !scalars.accepted {
        return;
    }
    if scalars.careful {
        // A rigid lift meets no more attraction than there is here, so that nothing stops it: small steps
        // would only take long.
        if params.may_detach && is_rigid_lift(params, scalars) {
            scalars.status = Status::PulledOff;
            return;
        }
        scalars.step = 1.0;
        scalars.length = 1.0;
        scalars.snap = 0.0;
        return;
    }
    if !rigid_motion(params, scalars) {
        // The majorant step: where the attraction falls with the gap the energy lies below this
        // parabola, so it needs no search.
        let majorant = -scalars.slope / scalars.curvature;
        scalars.length = majorant;
        scalars.step = if scalars.truncated {
            if majorant >= 0.6 { 1.0 } else { majorant }
        } else {
            majorant.min(scalars.step_first)
        };
        scalars.searching = params.law.has_tail() && scalars.step < scalars.step_first;
        scalars.evaluations = 0;
        scalars.low = [0.0, scalars.slope, 0.0];
        reach(scalars, scalars.step);
    }
}
scalar_kernel!(
    /// The step along s, by the curvature.
    STEP_WALL, step_wall
);

/// The steps that a pass of the search looks at, from the first one on.
fn reach(scalars: &mut Scalars, step: f64) {
    scalars.reached = REACHES.map(|reach| (step * reach).min(scalars.step_first));
}

fn search_wall(_: &Params, scalars: &mut Scalars) {
    if scalars.status != Status::Running || !scalars.searching {
        return;
    }
    let first = scalars.slope;
    scalars.evaluations += 1;
    let [mut before, mut slope_before, _] = scalars.low;
    for (t, change) in scalars.reached.into_iter().zip(scalars.sums) {
        let slope = first + t * scalars.curvature + change;
        // A slope that is no number is too far as well. The first step of all is never too far.
        let too_far = slope.is_nan() || slope > SEARCH_SHARE * first.abs();
        if before > 0.0 && too_far {
            // Too far. The energy curves no more than it does without the attraction, so that from the step
            // before it falls at least as far as the slope takes it to rise to zero.
            let safe = before - slope_before / scalars.curvature;
            scalars.step = safe.min(t);
            scalars.length = scalars.step;
            scalars.searching = false;
            return;
        }
        if before > 0.0 {
            scalars.length = t;
        }
        scalars.step = t;
        (before, slope_before) = (t, slope);
        if slope >= SEARCH_SHARE * first || t >= scalars.step_first {
            scalars.searching = false;
            return;
        }
    }
    scalars.low = [before, slope_before, 0.0];
    if scalars.evaluations > EXTRAPOLATIONS {
        scalars.searching = false;
        return;
    }
    reach(scalars, before * REACHES[1]);
}
scalar_kernel!(
    /// Lengthens a step while the energy still falls steeply.
    SEARCH_WALL, search_wall
);

fn settle_wall(params: &Params, scalars: &mut Scalars) {
    if scalars.waits() || !scalars.accepted || scalars.careful {
        return;
    }
    scalars.snap = if scalars.step == scalars.step_first {
        LEAST_SNAP.max(SNAP_ROUNDINGS * params.epsilon) * scalars.largest
    } else {
        0.0
    };
}
scalar_kernel!(
    /// What the step needs to know before it is taken.
    SETTLE_WALL, settle_wall
);

fn lengthen_wall(_: &Params, scalars: &mut Scalars) {
    if !scalars.waits() && scalars.accepted && !scalars.careful {
        scalars.trial *= scalars.length.clamp(0.3, 2.0);
    }
}
scalar_kernel!(
    /// The next trial length, after the step was taken.
    LENGTHEN_WALL, lengthen_wall
);

fn step_core(params: &Params, scalars: &mut Scalars) {
    if scalars.waits() || !scalars.accepted {
        return;
    }
    if !scalars.curvature.is_finite() {
        scalars.status = Status::NotFinite;
        return;
    }
    scalars.step = 1.0;
    scalars.searching = true;
    scalars.evaluations = 0;
    scalars.low = [0.0, scalars.slope, 0.0];
    scalars.high = [f64::INFINITY; 2];
    scalars.slope_at_one = f64::INFINITY;
    // The trial has evaluated this step on its way.
    scalars.sums.copy_within(AT_ONE..AT_ONE + 3, 0);
    search_core(params, scalars);
}
scalar_kernel!(
    /// Starts the search along s at step 1, which the trial's sums evaluate.
    STEP_CORE, step_core
);

fn search_core(params: &Params, scalars: &mut Scalars) {
    if scalars.status != Status::Running || !scalars.searching {
        return;
    }
    let t = scalars.step;
    let first = scalars.slope;
    let slope = first + t * scalars.curvature + scalars.sums[0];
    let energy = scalars.sums[1] + t * scalars.elastic_slope + 0.5 * t * t * scalars.curvature;
    // Differences of energies below this are rounding.
    let noise = 4.0 * params.epsilon * scalars.sums[2];
    let fallen = energy <= noise;
    if scalars.evaluations == 0 {
        scalars.slope_at_one = slope;
    }
    scalars.evaluations += 1;
    let [low, low_slope, _] = scalars.low;
    if scalars.evaluations >= EVALUATIONS {
        // The lower end has fallen; without one the direction is lost.
        scalars.searching = false;
        scalars.step = low;
        if low == 0.0 {
            scalars.accepted = false;
            scalars.iterations -= 1;
            stall(scalars);
        }
        return;
    }
    if fallen && slope.abs() <= SEARCH_SHARE * first.abs() {
        scalars.searching = false;
        return;
    }
    let still_falling = slope < SEARCH_SHARE * first && fallen;
    if still_falling && scalars.high[0].is_infinite() {
        if scalars.evaluations > EXTRAPOLATIONS {
            scalars.searching = false;
            return;
        }
        let rise = (slope - low_slope) / (t - low);
        let secant = if rise > 0.0 {
            -slope / rise
        } else {
            f64::INFINITY
        };
        scalars.low = [t, slope, energy];
        scalars.step = t + (3.0 * t).min(secant);
        return;
    }
    if still_falling {
        scalars.low = [t, slope, energy];
    } else {
        scalars.high = [t, slope];
    }
    let [low, low_slope, _] = scalars.low;
    let [high, high_slope] = scalars.high;
    let share = low_slope / (low_slope - high_slope);
    let share = if share.is_finite() {
        share.clamp(0.1, 0.9)
    } else {
        0.2
    };
    scalars.step = low + share * (high - low);
}
scalar_kernel!(
    /// Brackets the step at which the slope is small and the energy has fallen.
    SEARCH_CORE, search_core
);

fn lengthen_core(_: &Params, scalars: &mut Scalars) {
    if scalars.waits() || !scalars.accepted {
        return;
    }
    let t = scalars.step;
    if t < 1.0 {
        scalars.trial *= t.clamp(0.3, 1.0);
    } else if scalars.slope_at_one < SEARCH_SHARE * scalars.slope {
        scalars.trial *= t.clamp(1.5, 2.0);
    }
}
scalar_kernel!(
    /// The next trial length, after the step was taken.
    LENGTHEN_CORE, lengthen_core
);

fn balance_wall(_: &Params, scalars: &mut Scalars) {
    if scalars.waits() {
        return;
    }
    let [gap_pressure, gap, least, ..] = scalars.sums;
    scalars.mean_pressure = if gap > 0.0 {
        -gap_pressure / gap
    } else {
        -least
    };
}
scalar_kernel!(
    /// The mean pressure that a held mean gap asks for: minus the gap-weighted mean of p + sigma.
    BALANCE_WALL, balance_wall
);

fn balance_core(_: &Params, scalars: &mut Scalars) {
    if scalars.waits() {
        return;
    }
    let [pressure, share, ..] = scalars.sums;
    scalars.mean_pressure = -quotient(pressure, share);
}
scalar_kernel!(
    /// The same in the measure of the local compliance.
    BALANCE_CORE, balance_core
);
