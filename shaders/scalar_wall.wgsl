// The decisions that belong to laws with a hard wall.

// The share of a trial gap that brings it back to the held mean; gaps below zero are scaled the other way.
fn restore_yield() {
    if (waits()) {
        return;
    }
    scalars.restore = ZERO;
    let size = scalars.sums[1] + scalars.sums[0] + (scalars.sums[2] + scalars.sums[2]);
    if (size > ZERO) {
        scalars.restore = -scalars.sums[0] / size;
    }
}

// Whether the accepted step is a rigid motion; then says what becomes of it.
fn rigid_motion() -> bool {
    if (scalars.curvature > RIGID * abs(scalars.slope)) {
        return false;
    }
    if (!is_finite(scalars.curvature)) {
        scalars.status = NOT_FINITE;
    } else if (scalars.down > ZERO && params.may_detach != 0u) {
        scalars.status = PULLED_OFF;
    } else if (scalars.up < ZERO && is_finite(scalars.step_first)) {
        scalars.step = scalars.step_first;
        scalars.length = scalars.step;
    } else {
        scalars.accepted = 0u;
        stall();
    }
    return true;
}

// The step along s, by the curvature.
fn step_wall() {
    if (waits() || scalars.accepted == 0u) {
        return;
    }
    if (scalars.careful != 0u) {
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
    if (scalars.truncated != 0u) {
        scalars.step = select(majorant, ONE, majorant >= wide(0.6));
    } else {
        scalars.step = min(majorant, scalars.step_first);
    }
    scalars.searching = u32(params.law_has_tail != 0u && scalars.step < scalars.step_first);
    scalars.evaluations = 0u;
    scalars.low[0] = ZERO;
    scalars.low[1] = scalars.slope;
    scalars.low[2] = ZERO;
}

// Lengthens a step while the energy still falls steeply.
fn search_wall() {
    if (scalars.status != RUNNING || scalars.searching == 0u) {
        return;
    }
    let t = scalars.step;
    let slope = scalars.slope + t * scalars.curvature + scalars.sums[0];
    scalars.evaluations = scalars.evaluations + 1u;
    let before = scalars.low[0];
    let slope_before = scalars.low[1];
    if (scalars.evaluations > 1u && !(slope <= SEARCH_SHARE * abs(scalars.slope))) {
        // Too far: the last step stands.
        scalars.step = before;
        scalars.length = before;
        scalars.searching = 0u;
        return;
    }
    if (scalars.evaluations > 1u) {
        scalars.length = t;
    }
    if (slope >= SEARCH_SHARE * scalars.slope || scalars.evaluations > EXTRAPOLATIONS) {
        scalars.searching = 0u;
        return;
    }
    let rise = (slope - slope_before) / (t - before);
    var secant = params.infinity;
    if (rise > ZERO) {
        secant = -slope / rise;
    }
    let next = min(t + min(wide(4.0) * t, secant), scalars.step_first);
    scalars.low[0] = t;
    scalars.low[1] = slope;
    scalars.low[2] = ZERO;
    if (next > t) {
        scalars.step = next;
    } else {
        scalars.searching = 0u;
    }
}

// What the step needs to know before it is taken.
fn settle_wall() {
    if (waits() || scalars.accepted == 0u || scalars.careful != 0u) {
        return;
    }
    scalars.snap = ZERO;
    if (scalars.step == scalars.step_first) {
        scalars.snap = params.snap_share * scalars.largest;
    }
}

// The next trial length, after the step was taken.
fn lengthen_wall() {
    if (!waits() && scalars.accepted != 0u && scalars.careful == 0u) {
        scalars.trial = scalars.trial * clamp(scalars.length, wide(0.3), wide(2.0));
    }
}

// The mean pressure that a held mean gap asks for: minus the gap-weighted mean of p + sigma.
fn balance_wall() {
    if (waits()) {
        return;
    }
    if (scalars.sums[1] > ZERO) {
        scalars.mean_pressure = -scalars.sums[0] / scalars.sums[1];
    } else {
        scalars.mean_pressure = -scalars.sums[2];
    }
}
