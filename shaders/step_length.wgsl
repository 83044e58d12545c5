// How far a trial step is taken. Twins: kernel/step_length.rs.

// Whether the accepted step is a rigid motion; then decides what becomes of it. A prescribed mean gap leaves none.
fn rigid_motion() -> bool {
    if (scalars.curvature > RIGID * abs(scalars.slope)) {
        return false;
    }
    if (!is_finite(scalars.curvature)) {
        scalars.status = NOT_FINITE;
    } else if (scalars.least_step > ZERO && params.may_detach != 0u) {
        scalars.status = PULLED_OFF;
    } else if (scalars.largest_step < ZERO && is_finite(scalars.first_touch) && params.prescribed_mean_gap == 0u) {
        scalars.step = scalars.first_touch;
        scalars.length = scalars.step;
    } else {
        scalars.accepted = 0u;
        stall();
    }
    return true;
}

// Whether a step lifts all points by the same way.
fn is_rigid_lift() -> bool {
    let spread = scalars.largest_step - scalars.least_step;
    return scalars.least_step > ZERO && spread <= SAME_WAY * params.epsilon * scalars.largest_step;
}

// The step length by the curvature; of a smooth law the start of its search.
fn step_length() {
    if (waits() || scalars.accepted == 0u) {
        return;
    }
    if (params.law_has_wall == 0u) {
        start_bracket();
        return;
    }
    if (scalars.careful != 0u) {
        // A rigid lift meets no more attraction than there is here, so that nothing stops it.
        if (params.may_detach != 0u && is_rigid_lift()) {
            scalars.status = PULLED_OFF;
            return;
        }
        scalars.step = ONE;
        scalars.length = ONE;
        scalars.snap = ZERO;
        return;
    }
    if (rigid_motion()) {
        return;
    }
    // The majorant step: where the attraction falls with the gap the energy lies below this
    // parabola, so it needs no search.
    let majorant = -scalars.slope / scalars.curvature;
    scalars.length = majorant;
    if (scalars.cut != 0u) {
        scalars.step = select(majorant, ONE, majorant >= WHOLE_STEP);
    } else {
        scalars.step = min(majorant, scalars.first_touch);
    }
    scalars.searching = u32(params.law_has_tail != 0u && scalars.step < scalars.first_touch);
    scalars.evaluations = 0u;
    scalars.low[0] = ZERO;
    scalars.low[1] = scalars.slope;
    scalars.low[2] = ZERO;
    reach(scalars.step);
}

// The step lengths that a pass of the search tries, from the first one on.
fn reach(step: wide) {
    let farthest = scalars.first_touch;
    scalars.tried[0] = min(step, farthest);
    scalars.tried[1] = min(step * SECOND_REACH, farthest);
    scalars.tried[2] = min(step * THIRD_REACH, farthest);
    scalars.tried[3] = min(step * FOURTH_REACH, farthest);
}

// Lengthens a step while the energy still falls steeply; of a smooth law brackets it.
fn search() {
    if (scalars.status != RUNNING || scalars.searching == 0u) {
        return;
    }
    if (params.law_has_wall != 0u) {
        lengthen();
    } else {
        bracket();
    }
}

// Takes the largest tried step at which the energy still falls, or one that is guaranteed to.
fn lengthen() {
    let first = scalars.slope;
    scalars.evaluations = scalars.evaluations + 1u;
    var before = scalars.low[0];
    var slope_before = scalars.low[1];
    var changes = array<wide, 4>(scalars.sums_change_at_first, scalars.sums_change_at_second, scalars.sums_change_at_third, scalars.sums_change_at_fourth);
    for (var place = 0u; place < 4u; place = place + 1u) {
        let t = scalars.tried[place];
        let slope = first + t * scalars.curvature + changes[place];
        if (before > ZERO && !(slope <= SEARCH_SHARE * abs(first))) {
            // Too far. The energy curves no more than it does without the attraction, so that from the step
            // before it falls at least as far as the slope takes it to rise to zero.
            scalars.step = min(before - slope_before / scalars.curvature, t);
            scalars.length = scalars.step;
            scalars.searching = 0u;
            return;
        }
        if (before > ZERO) {
            scalars.length = t;
        }
        scalars.step = t;
        before = t;
        slope_before = slope;
        if (slope >= SEARCH_SHARE * first || t >= scalars.first_touch) {
            scalars.searching = 0u;
            return;
        }
    }
    scalars.low[0] = before;
    scalars.low[1] = slope_before;
    scalars.low[2] = ZERO;
    if (scalars.evaluations > EXTRAPOLATIONS) {
        scalars.searching = 0u;
        return;
    }
    reach(before * SECOND_REACH);
}

// Starts the search of a smooth law at step length 1, which the trial's sums evaluate.
fn start_bracket() {
    if (!is_finite(scalars.curvature)) {
        scalars.status = NOT_FINITE;
        return;
    }
    scalars.step = ONE;
    scalars.searching = 1u;
    scalars.evaluations = 0u;
    scalars.low = array<wide, 3>(ZERO, scalars.slope, ONE);
    scalars.high = array<wide, 3>(params.infinity, params.infinity, params.infinity);
    scalars.last_end = ZERO;
    bracket();
}

// A slope of the energy beside the first one, between -1 and 1. Near the root it is in proportion to the slope; deep in the
// repulsion, where the slope grows without end and a secant would hardly leave the other end, it is 1.
fn relative_slope(slope: wide, first: wide) -> wide {
    let relative = slope / (abs(first) + abs(slope));
    return select(ONE, relative, is_finite(relative));
}

// Brackets the step length at which the slope is small and the energy has fallen.
fn bracket() {
    let t = scalars.step;
    let first = scalars.slope;
    let slope = first + t * scalars.curvature + scalars.sums_change_at_first;
    let energy = scalars.sums_energy_change + t * scalars.elastic_slope + wide(0.5) * t * t * scalars.curvature;
    // Differences of energies below this are rounding.
    let noise = wide(4.0) * params.epsilon * scalars.sums_energy_size;
    let fallen = energy <= noise;
    scalars.evaluations = scalars.evaluations + 1u;
    if (scalars.evaluations >= EVALUATIONS) {
        // The lower end has fallen; without one the direction is lost.
        scalars.searching = 0u;
        scalars.step = scalars.low[0];
        if (scalars.low[0] == ZERO) {
            scalars.accepted = 0u;
            scalars.iterations = scalars.iterations - 1u;
            stall();
        }
        return;
    }
    if (fallen && abs(slope) <= SEARCH_SHARE * abs(first)) {
        scalars.searching = 0u;
        return;
    }
    let still_falling = slope < SEARCH_SHARE * first && fallen;
    if (still_falling && !is_finite(scalars.high[0])) {
        if (scalars.evaluations > EXTRAPOLATIONS) {
            scalars.searching = 0u;
            return;
        }
        let rise = (slope - scalars.low[1]) / (t - scalars.low[0]);
        var secant = params.infinity;
        if (rise > ZERO) {
            secant = -slope / rise;
        }
        scalars.low = array<wide, 3>(t, slope, ONE);
        scalars.step = t + min(wide(3.0) * t, secant);
        return;
    }
    // The secant of the relative slopes. An end that stays where it is while the other one moves twice counts half as
    // much (the Illinois method: Dowell & Jarratt 1971).
    let this_end = select(UPPER_END, LOWER_END, still_falling);
    let again = select(ONE, wide(0.5), scalars.last_end == this_end);
    scalars.last_end = this_end;
    if (still_falling) {
        scalars.low = array<wide, 3>(t, slope, ONE);
        scalars.high[2] = scalars.high[2] * again;
    } else {
        scalars.high = array<wide, 3>(t, slope, ONE);
        scalars.low[2] = scalars.low[2] * again;
    }
    let below = scalars.low[2] * relative_slope(scalars.low[1], first);
    let above = scalars.high[2] * relative_slope(scalars.high[1], first);
    // Where the energy has not fallen the slope may be negative at both ends.
    var share = wide(0.5);
    if (above > ZERO) {
        share = clamp(below / (below - above), wide(0.1), wide(0.9));
    }
    scalars.step = scalars.low[0] + share * (scalars.high[0] - scalars.low[0]);
}

// The gap below which a step to first touch closes a point.
fn snap_to_contact() {
    if (waits() || scalars.accepted == 0u || scalars.careful != 0u) {
        return;
    }
    scalars.snap = ZERO;
    if (scalars.step == scalars.first_touch) {
        scalars.snap = max(LEAST_SNAP, SNAP_ROUNDINGS * params.epsilon) * scalars.largest_move;
    }
}

// The next trial length, after the step was taken.
fn adapt_trial_length() {
    if (waits() || scalars.accepted == 0u) {
        return;
    }
    if (params.law_has_wall != 0u) {
        if (scalars.careful == 0u) {
            scalars.trial_length = scalars.trial_length * clamp(scalars.length, wide(0.3), wide(2.0));
        }
        return;
    }
    scalars.trial_length = scalars.trial_length * clamp(scalars.step, wide(0.3), wide(2.0));
}
