//! Scalar kernels of steps 5 and 6: how far a trial step is taken.

use super::scalar::{
    EVALUATIONS, EXTRAPOLATIONS, FOURTH_REACH, LEAST_SNAP, LOWER_END, RIGID, SAME_WAY,
    SEARCH_SHARE, SECOND_REACH, SNAP_ROUNDINGS, THIRD_REACH, UPPER_END, WHOLE_STEP, scalar_kernel,
    stall,
};
use crate::kernel::{Params, Scalars, Status};

/// Whether the accepted step is a rigid motion; then decides what becomes of it. A prescribed mean gap
/// leaves none: what looks like one is rounding.
fn rigid_motion(params: &Params, scalars: &mut Scalars) -> bool {
    if scalars.curvature > RIGID * scalars.slope.abs() {
        return false;
    }
    if !scalars.curvature.is_finite() {
        scalars.status = Status::NotFinite;
    } else if scalars.least_step > 0.0 && params.may_detach {
        scalars.status = Status::PulledOff;
    } else if scalars.largest_step < 0.0
        && scalars.first_touch.is_finite()
        && !params.prescribed_mean_gap
    {
        scalars.step = scalars.first_touch;
        scalars.length = scalars.step;
    } else {
        scalars.accepted = false;
        stall(scalars);
    }
    true
}

/// Whether a step lifts all points by the same way.
fn is_rigid_lift(params: &Params, scalars: &Scalars) -> bool {
    let spread = scalars.largest_step - scalars.least_step;
    scalars.least_step > 0.0 && spread <= SAME_WAY * params.epsilon * scalars.largest_step
}

fn step_length(params: &Params, scalars: &mut Scalars) {
    if scalars.waits() || !scalars.accepted {
        return;
    }
    if !params.law.has_wall() {
        start_bracket(params, scalars);
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
    if rigid_motion(params, scalars) {
        return;
    }
    // The majorant step: where the attraction falls with the gap the energy lies below this
    // parabola, so it needs no search.
    let majorant = -scalars.slope / scalars.curvature;
    scalars.length = majorant;
    if scalars.cut {
        scalars.step = if majorant >= WHOLE_STEP {
            1.0
        } else {
            majorant
        };
    } else {
        scalars.step = majorant.min(scalars.first_touch);
    }
    scalars.searching = params.law.has_tail() && scalars.step < scalars.first_touch;
    scalars.evaluations = 0;
    scalars.low = [0.0, scalars.slope, 0.0];
    reach(scalars, scalars.step);
}
scalar_kernel!(
    /// Step 5, `plain::step_length`: the step length by the curvature; of a smooth law the start of its search.
    STEP_LENGTH, step_length
);

/// The step lengths that a pass of the search tries, from the first one on.
fn reach(scalars: &mut Scalars, step: f64) {
    let most = scalars.first_touch;
    scalars.tried = [
        step.min(most),
        (step * SECOND_REACH).min(most),
        (step * THIRD_REACH).min(most),
        (step * FOURTH_REACH).min(most),
    ];
}

fn search(params: &Params, scalars: &mut Scalars) {
    if scalars.status != Status::Running || !scalars.searching {
        return;
    }
    if params.law.has_wall() {
        lengthen(scalars);
    } else {
        bracket(params, scalars);
    }
}
scalar_kernel!(
    /// Step 6: lengthens a step while the energy still falls steeply; of a smooth law brackets it.
    SEARCH, search
);

/// `plain::lengthen`: takes the largest tried step at which the energy still falls, or one that is
/// guaranteed to.
fn lengthen(scalars: &mut Scalars) {
    let first = scalars.slope;
    scalars.evaluations += 1;
    let [mut before, mut slope_before, _] = scalars.low;
    let sums = scalars.sums;
    let changes = [
        sums.change_at_first,
        sums.change_at_second,
        sums.change_at_third,
        sums.change_at_fourth,
    ];
    for (t, change) in scalars.tried.into_iter().zip(changes) {
        let slope = first + t * scalars.curvature + change;
        // A slope that is NaN is too far as well. The first step of all is never too far.
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
        if slope >= SEARCH_SHARE * first || t >= scalars.first_touch {
            scalars.searching = false;
            return;
        }
    }
    scalars.low = [before, slope_before, 0.0];
    if scalars.evaluations > EXTRAPOLATIONS {
        scalars.searching = false;
        return;
    }
    reach(scalars, before * SECOND_REACH);
}

/// Starts the search of a smooth law at step length 1, which the trial's sums evaluate.
fn start_bracket(params: &Params, scalars: &mut Scalars) {
    if !scalars.curvature.is_finite() {
        scalars.status = Status::NotFinite;
        return;
    }
    scalars.step = 1.0;
    scalars.searching = true;
    scalars.evaluations = 0;
    scalars.low = [0.0, scalars.slope, 1.0];
    scalars.high = [f64::INFINITY; 3];
    scalars.last_end = 0.0;
    bracket(params, scalars);
}

/// A slope of the energy beside the first one, between -1 and 1. Near the root it is in proportion to the slope; deep in the
/// repulsion, where the slope grows without end and a secant would hardly leave the other end, it is 1.
fn relative_slope(slope: f64, first: f64) -> f64 {
    let relative = slope / (first.abs() + slope.abs());
    if relative.is_finite() { relative } else { 1.0 }
}

/// `plain::bracket`: brackets the step length at which the slope is small and the energy has fallen.
fn bracket(params: &Params, scalars: &mut Scalars) {
    let t = scalars.step;
    let first = scalars.slope;
    let sums = scalars.sums;
    let slope = first + t * scalars.curvature + sums.change_at_first;
    let energy = sums.energy_change + t * scalars.elastic_slope + 0.5 * t * t * scalars.curvature;
    // Differences of energies below this are rounding.
    let noise = 4.0 * params.epsilon * sums.energy_size;
    let fallen = energy <= noise;
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
        scalars.low = [t, slope, 1.0];
        scalars.step = t + (3.0 * t).min(secant);
        return;
    }
    // The secant of the relative slopes. An end that stays where it is while the other one moves twice counts half as
    // much (the Illinois method: Dowell & Jarratt 1971).
    let this_end = if still_falling { LOWER_END } else { UPPER_END };
    let again = if scalars.last_end == this_end {
        0.5
    } else {
        1.0
    };
    scalars.last_end = this_end;
    if still_falling {
        scalars.low = [t, slope, 1.0];
        scalars.high[2] *= again;
    } else {
        scalars.high = [t, slope, 1.0];
        scalars.low[2] *= again;
    }
    let [
        [low, low_slope, low_weight],
        [high, high_slope, high_weight],
    ] = [scalars.low, scalars.high];
    let below = low_weight * relative_slope(low_slope, first);
    let above = high_weight * relative_slope(high_slope, first);
    // Where the energy has not fallen the slope may be negative at both ends.
    let share = if above > 0.0 {
        (below / (below - above)).clamp(0.1, 0.9)
    } else {
        0.5
    };
    scalars.step = low + share * (high - low);
}

fn snap_to_contact(params: &Params, scalars: &mut Scalars) {
    if scalars.waits() || !scalars.accepted || scalars.careful {
        return;
    }
    scalars.snap = 0.0;
    if scalars.step == scalars.first_touch {
        let share = LEAST_SNAP.max(SNAP_ROUNDINGS * params.epsilon);
        scalars.snap = share * scalars.largest_move;
    }
}
scalar_kernel!(
    /// Step 7: the gap below which a step to first touch closes a point.
    SNAP_TO_CONTACT, snap_to_contact
);

fn adapt_trial_length(params: &Params, scalars: &mut Scalars) {
    if scalars.waits() || !scalars.accepted {
        return;
    }
    if params.law.has_wall() {
        if !scalars.careful {
            scalars.trial_length *= scalars.length.clamp(0.3, 2.0);
        }
        return;
    }
    scalars.trial_length *= scalars.step.clamp(0.3, 2.0);
}
scalar_kernel!(
    /// The next trial length, after the step was taken.
    ADAPT_TRIAL_LENGTH, adapt_trial_length
);
