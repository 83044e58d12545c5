// The decisions that belong to laws with a hard wall.

// Steps that a pass of the search looks at, over the first one.
const REACHES = array<wide, 4>(1.0, 1.75, 3.0, 5.0);

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

// Whether the accepted step is a rigid motion; then says what becomes of it. A held mean gap leaves none.
fn rigid_motion() -> bool {
    if (scalars.curvature > RIGID * abs(scalars.slope)) {
        return false;
    }
    if (!is_finite(scalars.curvature)) {
        scalars.status = NOT_FINITE;
    } else if (scalars.down > ZERO && params.may_detach != 0u) {
        scalars.status = PULLED_OFF;
    } else if (scalars.up < ZERO && is_finite(scalars.step_first) && params.fixed_gap == 0u) {
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
        // A rigid lift meets no more attraction than there is here, so that nothing stops it.
        let same_way = scalars.up - scalars.down <= SAME_WAY * params.epsilon * scalars.up;
        if (params.may_detach != 0u && scalars.down > ZERO && same_way) {
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
    reach(scalars.step);
}

// The steps that a pass of the search looks at, from the first one on.
fn reach(step: wide) {
    scalars.reached[0] = min(step * REACHES[0], scalars.step_first);
    scalars.reached[1] = min(step * REACHES[1], scalars.step_first);
    scalars.reached[2] = min(step * REACHES[2], scalars.step_first);
    scalars.reached[3] = min(step * REACHES[3], scalars.step_first);
}

// Lengthens a step while the energy still falls steeply.
fn search_wall() {
    if (scalars.status != RUNNING || scalars.searching == 0u) {
        return;
    }
    let first = scalars.slope;
    scalars.evaluations = scalars.evaluations + 1u;
    var before = scalars.low[0];
    var slope_before = scalars.low[1];
    for (var place = 0u; place < 4u; place = place + 1u) {
        let t = scalars.reached[place];
        let slope = first + t * scalars.curvature + scalars.sums[place];
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
        if (slope >= SEARCH_SHARE * first || t >= scalars.step_first) {
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
    reach(before * REACHES[1]);
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
