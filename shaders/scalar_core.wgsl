// The decisions that belong to the Lennard-Jones law.

// The multiple of the local compliance that keeps the mean of a step zero.
fn restore_core() {
    if (waits()) {
        return;
    }
    scalars.restore = ZERO;
    if (params.fixed_gap != 0u) {
        scalars.restore = quotient(scalars.sums[0], scalars.sums[1]);
    }
}

// First of the sums in which a trial evaluates the step 1, as a search would.
const AT_ONE: u32 = 6u;

// Starts the search along s at step 1, which the trial's sums evaluate.
fn step_core() {
    if (waits() || scalars.accepted == 0u) {
        return;
    }
    if (!is_finite(scalars.curvature)) {
        scalars.status = NOT_FINITE;
        return;
    }
    scalars.step = ONE;
    scalars.searching = 1u;
    scalars.evaluations = 0u;
    scalars.low[0] = ZERO;
    scalars.low[1] = scalars.slope;
    scalars.low[2] = ZERO;
    scalars.high[0] = params.infinity;
    scalars.high[1] = params.infinity;
    // Not known yet: larger than any slope that would lengthen the next trial.
    scalars.slope_at_one = params.infinity;
    // The trial has evaluated this step on its way.
    scalars.sums[0] = scalars.sums[AT_ONE];
    scalars.sums[1] = scalars.sums[AT_ONE + 1u];
    scalars.sums[2] = scalars.sums[AT_ONE + 2u];
    search_core();
}

// Brackets the step at which the slope is small and the energy has fallen.
fn search_core() {
    if (scalars.status != RUNNING || scalars.searching == 0u) {
        return;
    }
    let t = scalars.step;
    let first = scalars.slope;
    let slope = first + t * scalars.curvature + scalars.sums[0];
    let energy = scalars.sums[1] + t * scalars.elastic_slope + wide(0.5) * t * t * scalars.curvature;
    // Differences of energies below this are rounding.
    let noise = wide(4.0) * params.epsilon * scalars.sums[2];
    let fallen = energy <= noise;
    if (scalars.evaluations == 0u) {
        scalars.slope_at_one = slope;
    }
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
        scalars.low[0] = t;
        scalars.low[1] = slope;
        scalars.low[2] = energy;
        scalars.step = t + min(wide(3.0) * t, secant);
        return;
    }
    if (still_falling) {
        scalars.low[0] = t;
        scalars.low[1] = slope;
        scalars.low[2] = energy;
    } else {
        scalars.high[0] = t;
        scalars.high[1] = slope;
    }
    var share = scalars.low[1] / (scalars.low[1] - scalars.high[1]);
    if (is_finite(share)) {
        share = clamp(share, wide(0.1), wide(0.9));
    } else {
        share = wide(0.2);
    }
    scalars.step = scalars.low[0] + share * (scalars.high[0] - scalars.low[0]);
}

// The next trial length, after the step was taken.
fn lengthen_core() {
    if (waits() || scalars.accepted == 0u) {
        return;
    }
    let t = scalars.step;
    if (t < ONE) {
        scalars.trial = scalars.trial * clamp(t, wide(0.3), ONE);
    } else if (scalars.slope_at_one < SEARCH_SHARE * scalars.slope) {
        scalars.trial = scalars.trial * max(min(t, wide(2.0)), wide(1.5));
    }
}

// The mean pressure that a held mean gap asks for, in the measure of the local compliance.
fn balance_core() {
    if (waits()) {
        return;
    }
    scalars.mean_pressure = -quotient(scalars.sums[0], scalars.sums[1]);
}
