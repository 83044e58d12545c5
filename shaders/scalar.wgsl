// Decisions of the algorithm, on the scalars alone. Twins: kernel/scalar.rs, whose constants come before.

const ZERO: wide = 0.0;
const ONE: wide = 1.0;

// The floor that rounding sets to the numerator of the stopping measure.
fn rounding_floor() -> wide {
    return FLOOR_FACTOR * params.epsilon * params.stiffness_max * max(params.heights_norm, scalars.gap_norm);
}

// The quotient with 0/0 = 0 and x/0 infinite.
fn quotient(numerator: wide, denominator: wide) -> wide {
    if (numerator == ZERO) {
        return ZERO;
    }
    return numerator / denominator;
}

fn give_up_direction() {
    scalars.beta = ZERO;
    scalars.trial_length = ONE;
    scalars.lost = 0u;
    scalars.repeat = 0u;
    scalars.restart = 1u;
}

fn stall() {
    give_up_direction();
    if (scalars.residual < wide(0.5) * scalars.residual_at_stall) {
        scalars.stalls = 0u;
    }
    scalars.residual_at_stall = scalars.residual;
    scalars.stalls = scalars.stalls + 1u;
    if (scalars.stalls >= STALLS) {
        scalars.status = STALLED;
    }
}

// The stopping measure from its sums, and what follows from it.
fn test_convergence() {
    // After a lost trial the state is the one that was tested.
    if (waits() || scalars.lost > 0u) {
        return;
    }
    scalars.numerator = sqrt(scalars.sums_violation);
    scalars.least_gap = scalars.sums_least_gap;
    scalars.gap_norm = sqrt(scalars.sums_gap_squares);
    let pressures_norm = sqrt(scalars.sums_pressures);
    let floor_of_rounding = rounding_floor();
    // Between flat surfaces there may be no pressure at all. 0/0 counts as 0, and what rounding alone has left of
    // either is 0.
    let detached = params.may_detach != 0u && scalars.sums_least_gap > DETACHED_RANGES * params.law_range;
    let nothing = params.pressure_floor == ZERO && pressures_norm <= floor_of_rounding && !detached;
    scalars.residual = quotient(scalars.numerator, max(pressures_norm, params.pressure_floor));
    if (nothing && scalars.numerator <= floor_of_rounding) {
        scalars.residual = ZERO;
    }
    let finite = is_finite(scalars.sums_violation) && is_finite(scalars.sums_pressures) && is_finite(scalars.sums_gap_squares);
    if (!finite) {
        scalars.status = NOT_FINITE;
    } else if (scalars.residual <= params.tolerance) {
        scalars.status = CONVERGED;
    } else if (detached) {
        scalars.status = PULLED_OFF;
    } else if (scalars.numerator <= floor_of_rounding) {
        scalars.at_floor = scalars.at_floor + 1u;
        if (scalars.at_floor >= AT_FLOOR) {
            scalars.status = STALLED;
        }
    } else {
        scalars.at_floor = 0u;
    }
    // Beyond the range of a sharp law nothing attracts: under tension there is no way back, and else not if all
    // steps still to come, a geometric series, do not lead there.
    let beyond = scalars.sums_least_gap - params.law_range;
    let way_left = scalars.largest_move / CAREFUL_LENGTH;
    let separated = beyond > ZERO && (params.may_detach != 0u || (scalars.accepted != 0u && way_left < beyond));
    let careful_enough = scalars.residual < CAREFUL_UNTIL || scalars.iterations >= CAREFUL_MOST;
    if (scalars.careful != 0u && (separated || careful_enough)) {
        scalars.careful = 0u;
        give_up_direction();
    }
}

// Beta of the conjugate direction (Polak-Ribiere, never negative).
fn conjugate_direction() {
    if (waits() || scalars.repeat != 0u) {
        return;
    }
    // Under a prescribed mean gap z and d carry no mean over the free points (in the measure of the local
    // compliance, for a smooth law).
    var z_mean = ZERO;
    var d_mean = ZERO;
    var residual_sum = ZERO;
    var change_sum = ZERO;
    if (params.prescribed_mean_gap != 0u) {
        z_mean = quotient(scalars.sums_weighted_z, scalars.sums_free_weight);
        d_mean = quotient(scalars.sums_weighted_direction, scalars.sums_free_weight);
        residual_sum = scalars.sums_free_residual;
        change_sum = scalars.sums_free_change;
    }
    let z_residual = scalars.sums_z_residual - z_mean * residual_sum;
    let z_change = scalars.sums_z_change - z_mean * change_sum;
    var beta = ZERO;
    if (scalars.sums_direction_change > ZERO) {
        beta = max(z_change / scalars.sums_direction_change, ZERO);
    }
    if (scalars.restart != 0u || scalars.careful != 0u || !is_finite(beta)) {
        beta = ZERO;
    }
    scalars.restart = 0u;
    let slope = -z_residual + beta * (scalars.sums_direction_residual - d_mean * residual_sum);
    if (slope >= -SLOPE_SHARE * z_residual) {
        beta = ZERO;
    }
    scalars.descent_factor = -ONE;
    scalars.beta = beta;
    scalars.mean_gap_shift = z_mean - beta * d_mean;
    if (scalars.careful != 0u) {
        scalars.trial_length = CAREFUL_LENGTH;
    }
}

// Takes a trial that descends; otherwise shortens it and has it repeated.
fn accept_trial() {
    if (waits()) {
        return;
    }
    scalars.accepted = 0u;
    let slope = scalars.sums_slope;
    if (!is_finite(slope)) {
        scalars.status = NOT_FINITE;
        return;
    }
    scalars.slope = slope;
    scalars.elastic_slope = scalars.sums_elastic_slope;
    scalars.first_touch = max(scalars.sums_first_touch, ONE);
    scalars.largest_step = scalars.sums_largest_step;
    scalars.least_step = scalars.sums_least_step;
    scalars.largest_move = max(scalars.largest_step, -scalars.least_step);
    scalars.cut = u32(scalars.sums_cut > ZERO);
    if (slope < ZERO || (scalars.careful != 0u && scalars.largest_move > ZERO)) {
        scalars.accepted = 1u;
        scalars.repeat = 0u;
        scalars.lost = 0u;
        scalars.iterations = scalars.iterations + 1u;
        return;
    }
    scalars.lost = scalars.lost + 1u;
    if (scalars.lost >= LOST_TRIALS || scalars.largest_move == ZERO) {
        stall();
        return;
    }
    scalars.trial_length = scalars.trial_length * SHORTEN;
    // The trial has taken the place of the descent, which is found again where it is wanted.
    scalars.restart = u32(scalars.lost == LOST_BEFORE_DESCENT);
    scalars.repeat = u32(scalars.lost != LOST_BEFORE_DESCENT);
    scalars.descent_factor = ZERO;
    scalars.beta = ONE;
    scalars.mean_gap_shift = ZERO;
}
