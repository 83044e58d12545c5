// declarations.wgsl
// common.wgsl
@group(0) @binding(1) var<storage, read_write> scalars: Scalars;
// gate.wgsl
// sums.wgsl
// reduce.wgsl
const LOST_TRIALS: u32 = 25;
const LOST_BEFORE_DESCENT: u32 = 5;
const SHORTEN: wide = 0.3;
const STALLS: u32 = 4;
const AT_FLOOR: u32 = 20;
const SLOPE_SHARE: wide = 1e-6;
const RIGID: wide = 1e-30;
const SAME_WAY: wide = 16.0;
const DETACHED_RANGES: wide = 60.0;
const FLOOR_FACTOR: wide = 2.0;
const LEAST_SNAP: wide = 1e-12;
const SNAP_ROUNDINGS: wide = 8.0;
const CAREFUL_LENGTH: wide = 0.25;
const CAREFUL_UNTIL: wide = 1e-3;
const CAREFUL_MOST: u32 = 2000;
const WHOLE_STEP: wide = 0.6;
const SEARCH_SHARE: wide = 0.1;
const SECOND_REACH: wide = 1.75;
const THIRD_REACH: wide = 3.0;
const FOURTH_REACH: wide = 5.0;
const EXTRAPOLATIONS: u32 = 6;
const EVALUATIONS: u32 = 40;
const LOWER_END: wide = -1.0;
const UPPER_END: wide = 1.0;
const VANISHES: wide = 8.0;
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
var<private> sum_0: part;
fn into_0(term: wide) { sum_0 = add(sum_0, term); }
var<private> sum_1: part;
fn into_1(term: wide) { sum_1 = add(sum_1, term); }
var<private> sum_2: part;
fn into_2(term: wide) { sum_2 = least(sum_2, term); }
var<private> sum_3: part;
fn into_3(term: wide) { sum_3 = add(sum_3, term); }
fn start_sums() {
sum_0 = part_of(wide(0.0));
sum_1 = part_of(wide(0.0));
sum_2 = part_of(params.infinity);
sum_3 = part_of(wide(0.0));
}
var<workgroup> group_values: array<part, 1024>;
var<workgroup> totals: array<wide, 4>;
fn put_together(thread: u32) {
start_sums();
for (var group = thread; group < 7u; group = group + 256u) {
sum_0 = join_add(sum_0, partials.values[0u + group]);
sum_1 = join_add(sum_1, partials.values[7u + group]);
sum_2 = join_min(sum_2, partials.values[14u + group]);
sum_3 = join_add(sum_3, partials.values[21u + group]);
}
group_values[0u + thread] = sum_0;
group_values[256u + thread] = sum_1;
group_values[512u + thread] = sum_2;
group_values[768u + thread] = sum_3;
workgroupBarrier();
if (thread < 128u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[128u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[384u + thread]);
group_values[512u + thread] = join_min(group_values[512u + thread], group_values[640u + thread]);
group_values[768u + thread] = join_add(group_values[768u + thread], group_values[896u + thread]);
}
workgroupBarrier();
if (thread < 64u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[64u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[320u + thread]);
group_values[512u + thread] = join_min(group_values[512u + thread], group_values[576u + thread]);
group_values[768u + thread] = join_add(group_values[768u + thread], group_values[832u + thread]);
}
workgroupBarrier();
if (thread < 32u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[32u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[288u + thread]);
group_values[512u + thread] = join_min(group_values[512u + thread], group_values[544u + thread]);
group_values[768u + thread] = join_add(group_values[768u + thread], group_values[800u + thread]);
}
workgroupBarrier();
if (thread < 16u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[16u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[272u + thread]);
group_values[512u + thread] = join_min(group_values[512u + thread], group_values[528u + thread]);
group_values[768u + thread] = join_add(group_values[768u + thread], group_values[784u + thread]);
}
workgroupBarrier();
if (thread < 8u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[8u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[264u + thread]);
group_values[512u + thread] = join_min(group_values[512u + thread], group_values[520u + thread]);
group_values[768u + thread] = join_add(group_values[768u + thread], group_values[776u + thread]);
}
workgroupBarrier();
if (thread < 4u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[4u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[260u + thread]);
group_values[512u + thread] = join_min(group_values[512u + thread], group_values[516u + thread]);
group_values[768u + thread] = join_add(group_values[768u + thread], group_values[772u + thread]);
}
workgroupBarrier();
if (thread < 2u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[2u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[258u + thread]);
group_values[512u + thread] = join_min(group_values[512u + thread], group_values[514u + thread]);
group_values[768u + thread] = join_add(group_values[768u + thread], group_values[770u + thread]);
}
workgroupBarrier();
if (thread < 1u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[1u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[257u + thread]);
group_values[512u + thread] = join_min(group_values[512u + thread], group_values[513u + thread]);
group_values[768u + thread] = join_add(group_values[768u + thread], group_values[769u + thread]);
}
workgroupBarrier();
if (thread == 0u) {
totals[0] = part_value(group_values[0u]);
totals[1] = part_value(group_values[256u]);
totals[2] = part_value(group_values[512u]);
totals[3] = part_value(group_values[768u]);
}
workgroupBarrier();
}
@compute @workgroup_size(256)
fn decide(@builtin(local_invocation_index) thread: u32) {
put_together(thread);
if (thread == 0u) {
if (gate_always()) {
scalars.sums_violation = totals[0];
scalars.sums_pressures = totals[1];
scalars.sums_least_gap = totals[2];
scalars.sums_gap_squares = totals[3];
}
test_convergence();
conjugate_direction();
accept_trial();
restore_mean_gap();
curvature_by_linearity();
mean_pressure();
restore_outer_mean_gap();
step_length();
search();
snap_to_contact();
adapt_trial_length();
}
}
