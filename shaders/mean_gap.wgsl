// Decisions under a prescribed mean gap. Twins: kernel/mean_gap.rs.

// The share of each trial gap that brings the mean back to the prescribed one.
fn restore_mean_gap() {
    if (waits()) {
        return;
    }
    if (params.law_has_wall == 0u) {
        restore_by_compliance();
    } else if (is_finite(params.hardness)) {
        restore_both_sides();
    } else {
        restore_by_linearity();
    }
}

// The multiple of the local compliance that keeps the mean of a smooth law's step zero.
fn restore_by_compliance() {
    scalars.mean_gap_correction = quotient(scalars.sums_step_sum, scalars.sums_compliance_sum);
}

// Of a solid with a hardness: gaps below zero are scaled the other way.
fn restore_both_sides() {
    let size = scalars.sums_gap_sum + scalars.sums_step_sum + (scalars.sums_depth_sum + scalars.sums_depth_sum);
    scalars.mean_gap_correction = ZERO;
    if (size > ZERO) {
        scalars.mean_gap_correction = -scalars.sums_step_sum / size;
    }
}

// Over a unilateral constraint: puts in place of the sums over s0 those over s.
fn restore_by_linearity() {
    let open = scalars.sums_gap_sum;
    let trial = open + scalars.sums_step_sum;
    var correction = ZERO;
    if (trial > ZERO) {
        correction = -scalars.sums_step_sum / trial;
    }
    let whole = ONE + correction;
    scalars.mean_gap_correction = correction;
    scalars.sums_slope = whole * scalars.sums_slope + correction * scalars.sums_gap_slope;
    // A point that was cut touches at the step 1 exactly.
    let closing = scalars.sums_closing;
    var most = ONE;
    if (closing < ONE) {
        most = whole * closing - correction;
    }
    scalars.sums_first_touch = params.infinity;
    if (open > ZERO && most > ZERO) {
        scalars.sums_first_touch = ONE / most;
    }
    if (open > ZERO && trial <= ZERO) {
        // Nothing is left of the gap that could be scaled back.
        scalars.sums_slope = ZERO;
    }
    if (open > ZERO && most <= VANISHES * params.epsilon * (abs(closing) + abs(correction))) {
        // The step vanishes but for its rounding.
        scalars.sums_slope = ZERO;
        scalars.sums_first_touch = params.infinity;
        scalars.sums_largest_step = ZERO;
        scalars.sums_least_step = ZERO;
        return;
    }
    scalars.sums_largest_step = whole * scalars.sums_largest_step;
    scalars.sums_least_step = whole * scalars.sums_least_step;
}

// <s, K s> from <s0, K s0>, which the convolution has handed in.
fn curvature_by_linearity() {
    if (waits() || scalars.accepted == 0u) {
        return;
    }
    let correction = scalars.mean_gap_correction;
    let whole = ONE + correction;
    let step = whole * whole * scalars.curvature;
    let mixed = wide(2.0) * whole * correction * scalars.sums_step_gap_curvature;
    let own = correction * correction * scalars.sums_gap_curvature;
    scalars.curvature = step + mixed + own;
    // Where the sums over K g cancel completely they must not be taken for a motion without curvature.
    let least_curvature = params.epsilon * (step + abs(mixed) + abs(own));
    if (scalars.curvature < least_curvature) {
        scalars.curvature = least_curvature;
    }
}

// The mean pressure that a prescribed mean gap takes: minus the weighted mean of p + sigma.
fn mean_pressure() {
    if (waits()) {
        return;
    }
    if (scalars.sums_pressure_weight > ZERO) {
        scalars.mean_pressure = -scalars.sums_weighted_pressure / scalars.sums_pressure_weight;
    } else {
        scalars.mean_pressure = -scalars.sums_least_pressure;
    }
}

// The share of each point's weight that brings the mean gap of the outer state back; 0 where nothing has any.
fn restore_outer_mean_gap() {
    scalars.mean_gap_correction = ZERO;
    if (scalars.sums_restoring_weight > ZERO) {
        scalars.mean_gap_correction = scalars.sums_gap_excess / scalars.sums_restoring_weight;
    }
}
