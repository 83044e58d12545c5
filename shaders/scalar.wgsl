// Every decision of the algorithm, on the scalars alone. Twins: kernel::scalar.
// Slots of `sums` are those that the kernels before fill.

// Trials that may be lost in a row before the direction is given up.
const LOST_TRIALS: u32 = 25u;
// Lost trials after which the plain descent takes the direction's place.
const LOST_BEFORE_DESCENT: u32 = 5u;
// Factor on the trial length after a lost trial.
const SHORTEN: wide = 0.3;
// Stalls without progress that end a solve.
const STALLS: u32 = 4u;
// Iterations at the floor of rounding that end a solve.
const AT_FLOOR: u32 = 20u;
// A direction whose slope is above this share of the descent's is given up.
const SLOPE_SHARE: wide = 1e-6;
// Curvature over slope below which a step is a rigid motion.
const RIGID: wide = 1e-30;
// Roundings within which all points of a step go the same way.
const SAME_WAY: wide = 16.0;
// Ranges beyond which surfaces under tension have left each other.
const DETACHED_RANGES: wide = 60.0;
// The rounding floor of the numerator over epsilon K_max norm(h or g).
const FLOOR_FACTOR: wide = 1.0;
// Step along the plain descent in careful mode.
const CAREFUL_LENGTH: wide = 0.25;
// Residual at which careful mode ends.
const CAREFUL_UNTIL: wide = 1e-3;
// Iterations after which careful mode ends all the same.
const CAREFUL_MOST: u32 = 2000u;
// Share of the first slope at which a search ends.
const SEARCH_SHARE: wide = 0.1;
// Extrapolations that one search may make.
const EXTRAPOLATIONS: u32 = 6u;
// Evaluations that one Lennard-Jones search may make.
const EVALUATIONS: u32 = 40u;

const ZERO: wide = 0.0;
const ONE: wide = 1.0;

// The quotient with 0/0 = 0 and x/0 infinite.
fn quotient(numerator: wide, denominator: wide) -> wide {
    if (numerator == ZERO) {
        return ZERO;
    }
    return numerator / denominator;
}

fn give_up_direction() {
    scalars.memory = ZERO;
    scalars.trial = ONE;
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
fn judge() {
    // After a lost trial the state is the one that was judged.
    if (waits() || scalars.lost > 0u) {
        return;
    }
    let violation = scalars.sums[0];
    let pressures = scalars.sums[1];
    let least_gap = scalars.sums[2];
    let gaps = scalars.sums[3];
    scalars.numerator = sqrt(violation);
    scalars.least_gap = least_gap;
    scalars.gap_norm = sqrt(gaps);
    let pressures_norm = sqrt(pressures);
    let floor_of_rounding = FLOOR_FACTOR * params.epsilon * params.stiffness_max * max(params.heights_norm, scalars.gap_norm);
    // Between flat surfaces there may be no pressure at all. 0/0 counts as 0, and what rounding alone has left of
    // either is 0.
    let detached = params.may_detach != 0u && least_gap > DETACHED_RANGES * params.law_range;
    let nothing = params.pressure_floor == ZERO && pressures_norm <= floor_of_rounding && !detached;
    scalars.residual = quotient(scalars.numerator, max(pressures_norm, params.pressure_floor));
    if (nothing && scalars.numerator <= floor_of_rounding) {
        scalars.residual = ZERO;
    }
    if (!is_finite(violation) || !is_finite(pressures) || !is_finite(gaps)) {
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
    // Beyond the range of a sharp law nothing sticks: under tension there is no way back, and else not if all
    // that is left of the way, a geometric series of steps like the last, does not lead there.
    let beyond = least_gap - params.law_range;
    let way_left = scalars.largest / CAREFUL_LENGTH;
    let apart = beyond > ZERO && (params.may_detach != 0u || (scalars.accepted != 0u && way_left < beyond));
    let careful_enough = scalars.residual < CAREFUL_UNTIL || scalars.iterations >= CAREFUL_MOST;
    if (scalars.careful != 0u && (apart || careful_enough)) {
        scalars.careful = 0u;
        give_up_direction();
    }
}

// Keeps what the last step says of its direction.
fn carry() {
    if (!waits()) {
        scalars.carried[0] = scalars.sums[4];
        scalars.carried[1] = scalars.sums[5];
    }
}

// The conjugacy of the new direction (Polak-Ribiere, never negative).
fn direct() {
    if (waits() || scalars.repeat != 0u) {
        return;
    }
    // Which points are free is known only after the mean pressure where that follows from the gap.
    var d_change = scalars.carried[0];
    var dy = scalars.carried[1];
    if (params.fixed_gap != 0u) {
        d_change = scalars.sums[2];
        dy = scalars.sums[3];
    }
    let y_sum = scalars.sums[6];
    // Under a held mean gap z and d carry no mean over the free points (in the measure of the local
    // compliance, for Lennard-Jones).
    var z_mean = ZERO;
    var d_mean = ZERO;
    if (params.fixed_gap != 0u) {
        z_mean = quotient(scalars.sums[4], scalars.sums[5]);
        d_mean = quotient(scalars.sums[8], scalars.sums[5]);
    }
    let zy = scalars.sums[0] - z_mean * y_sum;
    let z_change = scalars.sums[1] - z_mean * scalars.sums[7];
    var memory = ZERO;
    if (d_change > ZERO) {
        memory = max(z_change / d_change, ZERO);
    }
    if (scalars.restart != 0u || scalars.careful != 0u || !is_finite(memory)) {
        memory = ZERO;
    }
    scalars.restart = 0u;
    let slope = -zy + memory * (dy - d_mean * y_sum);
    if (slope >= -SLOPE_SHARE * zy) {
        memory = ZERO;
    }
    scalars.descent = -ONE;
    scalars.memory = memory;
    scalars.shift = z_mean - memory * d_mean;
    if (scalars.careful != 0u) {
        scalars.trial = CAREFUL_LENGTH;
    }
}

// Takes a trial that descends; otherwise shortens it and has it repeated.
fn accept() {
    if (waits()) {
        return;
    }
    scalars.accepted = 0u;
    let slope = scalars.sums[0];
    if (!is_finite(slope)) {
        scalars.status = NOT_FINITE;
        return;
    }
    scalars.slope = slope;
    scalars.elastic_slope = scalars.sums[5];
    scalars.step_first = max(scalars.sums[1], ONE);
    scalars.up = scalars.sums[2];
    scalars.down = scalars.sums[3];
    scalars.largest = max(scalars.up, -scalars.down);
    scalars.truncated = u32(scalars.sums[4] > ZERO);
    if (slope < ZERO || (scalars.careful != 0u && scalars.largest > ZERO)) {
        scalars.accepted = 1u;
        scalars.repeat = 0u;
        scalars.lost = 0u;
        scalars.iterations = scalars.iterations + 1u;
        return;
    }
    scalars.lost = scalars.lost + 1u;
    if (scalars.lost >= LOST_TRIALS || scalars.largest == ZERO) {
        stall();
        return;
    }
    scalars.trial = scalars.trial * SHORTEN;
    // The trial has taken the place of the descent, which is found again where it is wanted.
    scalars.restart = u32(scalars.lost == LOST_BEFORE_DESCENT);
    scalars.repeat = u32(scalars.lost != LOST_BEFORE_DESCENT);
    scalars.descent = ZERO;
    scalars.memory = ONE;
    scalars.shift = ZERO;
}
