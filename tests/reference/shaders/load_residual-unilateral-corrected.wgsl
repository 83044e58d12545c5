alias real = f32;
alias wide = f32;
struct Params {
    law_work: wide,
    law_range: wide,
    law_peak: wide,
    law_taper: wide,
    law_peak_gap: wide,
    law_has_tail: u32,
    law_has_wall: u32,
    stiffness_max: wide,
    pressure_floor: wide,
    tolerance: wide,
    heights_norm: wide,
    points: wide,
    smooth_stiffness: wide,
    level_compliance: wide,
    own_compliance: wide,
    neighbour_compliance: wide,
    softening: wide,
    hardness: wide,
    epsilon: wide,
    prescribed_mean_gap: u32,
    may_detach: u32,
    infinity: wide,
    zero: u32,
}
struct Scalars {
    sums_violation: wide,
    sums_pressures: wide,
    sums_least_gap: wide,
    sums_gap_squares: wide,
    sums_z_residual: wide,
    sums_z_change: wide,
    sums_direction_change: wide,
    sums_direction_residual: wide,
    sums_weighted_z: wide,
    sums_free_weight: wide,
    sums_free_residual: wide,
    sums_free_change: wide,
    sums_weighted_direction: wide,
    sums_slope: wide,
    sums_first_touch: wide,
    sums_largest_step: wide,
    sums_least_step: wide,
    sums_cut: wide,
    sums_elastic_slope: wide,
    sums_closing: wide,
    sums_step_sum: wide,
    sums_gap_sum: wide,
    sums_gap_slope: wide,
    sums_step_gap_curvature: wide,
    sums_gap_curvature: wide,
    sums_depth_sum: wide,
    sums_compliance_sum: wide,
    sums_change_at_first: wide,
    sums_change_at_second: wide,
    sums_change_at_third: wide,
    sums_change_at_fourth: wide,
    sums_energy_change: wide,
    sums_energy_size: wide,
    sums_weighted_pressure: wide,
    sums_pressure_weight: wide,
    sums_least_pressure: wide,
    sums_gap_excess: wide,
    sums_restoring_weight: wide,
    mean_pressure: wide,
    offset: wide,
    descent_factor: wide,
    beta: wide,
    mean_gap_shift: wide,
    trial_length: wide,
    mean_gap_correction: wide,
    slope: wide,
    curvature: wide,
    elastic_slope: wide,
    largest_step: wide,
    least_step: wide,
    largest_move: wide,
    step: wide,
    length: wide,
    first_touch: wide,
    snap: wide,
    low: array<wide, 3>,
    high: array<wide, 3>,
    tried: array<wide, 4>,
    last_end: wide,
    residual: wide,
    numerator: wide,
    residual_at_stall: wide,
    least_gap: wide,
    gap_norm: wide,
    status: u32,
    repeat: u32,
    restart: u32,
    accepted: u32,
    cut: u32,
    searching: u32,
    careful: u32,
    evaluations: u32,
    lost: u32,
    stalls: u32,
    at_floor: u32,
    iterations: u32,
}
const IN_SINGLE: wide = 1.0;
const RUNNING: u32 = 0u;
const CONVERGED: u32 = 1u;
const STALLED: u32 = 2u;
const PULLED_OFF: u32 = 3u;
const NOT_FINITE: u32 = 4u;
// common.wgsl
@group(0) @binding(1) var<storage, read> scalars: Scalars;
// gate.wgsl
// A sum while it is added up, and what of it passes between threads: a number and what rounding took from it,
// where the device has single precision alone.
alias part = vec2<f32>;

// The same number, which no compiler knows to be: `params.zero` is zero. Without it the error terms
// below are simplified away.
fn opaque(value: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(value) ^ params.zero);
}

// A sum and its rounding error (Knuth 1969, 4.2.2).
fn two_sum(a: f32, b: f32) -> vec2<f32> {
    let sum = opaque(a + b);
    let second = opaque(sum - a);
    let first = opaque(sum - second);
    return vec2<f32>(sum, opaque(opaque(a - first) + opaque(b - second)));
}

fn part_of(value: wide) -> part {
    return vec2<f32>(value, 0.0);
}

fn add(sum: part, term: wide) -> part {
    let added = two_sum(sum.x, term);
    return vec2<f32>(added.x, sum.y + added.y);
}

fn least(sum: part, term: wide) -> part {
    return vec2<f32>(select(sum.x, term, term < sum.x), sum.y);
}

fn most(sum: part, term: wide) -> part {
    return vec2<f32>(select(sum.x, term, term > sum.x), sum.y);
}

// What of it is compared.
fn leading(value: part) -> f32 {
    return value.x;
}

fn part_value(value: part) -> f32 {
    // Beyond the largest number the error is none.
    return select(value.x + value.y, value.x, !is_finite(value.x));
}

fn join_add(a: part, b: part) -> part {
    let added = two_sum(a.x, b.x);
    return vec2<f32>(added.x, added.y + (a.y + b.y));
}
// reduce.wgsl
var<private> sum_violation: part;
fn into_violation(term: wide) { sum_violation = add(sum_violation, term); }
var<private> sum_pressures: part;
fn into_pressures(term: wide) { sum_pressures = add(sum_pressures, term); }
var<private> sum_least_gap: part;
fn into_least_gap(term: wide) { sum_least_gap = least(sum_least_gap, term); }
var<private> sum_gap_squares: part;
fn into_gap_squares(term: wide) { sum_gap_squares = add(sum_gap_squares, term); }
fn start_sums() {
sum_violation = part_of(wide(0.0));
sum_pressures = part_of(wide(0.0));
sum_least_gap = part_of(params.infinity);
sum_gap_squares = part_of(wide(0.0));
}
var<workgroup> group_values: array<part, 32>;
fn hand_in(group: u32, thread: u32) {
group_values[0u + thread] = sum_violation;
group_values[8u + thread] = sum_pressures;
group_values[16u + thread] = sum_least_gap;
group_values[24u + thread] = sum_gap_squares;
workgroupBarrier();
if (thread < 4u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[4u + thread]);
group_values[8u + thread] = join_add(group_values[8u + thread], group_values[12u + thread]);
group_values[16u + thread] = join_min(group_values[16u + thread], group_values[20u + thread]);
group_values[24u + thread] = join_add(group_values[24u + thread], group_values[28u + thread]);
}
workgroupBarrier();
if (thread < 2u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[2u + thread]);
group_values[8u + thread] = join_add(group_values[8u + thread], group_values[10u + thread]);
group_values[16u + thread] = join_min(group_values[16u + thread], group_values[18u + thread]);
group_values[24u + thread] = join_add(group_values[24u + thread], group_values[26u + thread]);
}
workgroupBarrier();
if (thread < 1u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[1u + thread]);
group_values[8u + thread] = join_add(group_values[8u + thread], group_values[9u + thread]);
group_values[16u + thread] = join_min(group_values[16u + thread], group_values[17u + thread]);
group_values[24u + thread] = join_add(group_values[24u + thread], group_values[25u + thread]);
}
workgroupBarrier();
if (thread == 0u) {
partials.values[0u + group] = group_values[0u];
partials.values[1u + group] = group_values[8u];
partials.values[2u + group] = group_values[16u];
partials.values[3u + group] = group_values[24u];
}
}
fn row_of(index: u32) -> u32 {
return index / 8u;
}
fn in_domain(index: u32) -> bool { return index % 8u < 5u && row_of(index) < 4u; }
@group(1) @binding(0) var<storage, read> field_gap: array<real>;
fn read_gap(index: u32) -> real { return fields_here.gap; }
@group(1) @binding(1) var<storage, read> field_pressure: array<real>;
fn read_pressure(index: u32) -> real { return fields_here.pressure; }
fn read_projected_residual(index: u32) -> real { return 0.0; }
fn write_projected_residual(index: u32, value: real) {}
@group(1) @binding(2) var<storage, read> law_factors: array<real>;
var<private> law_factor: real;
@group(1) @binding(3) var<storage, read> known_gaps: array<real>;
var<private> known_gap: real;
struct Fields { gap: real, pressure: real, law_factor: real, known_gap: real,  }
var<private> fields_here: Fields;
fn fields_at(index: u32) -> Fields { return Fields(field_gap[index], field_pressure[index], law_factors[index], known_gaps[index], ); }
fn visit(index: u32, fields: Fields, line: real) -> real { fields_here = fields; law_factor = fields.law_factor; known_gap = fields.known_gap; return at(index, in_domain(index), line); }
const WIDTH: u32 = 8u;
const HEIGHT: u32 = 8u;
// exp in single precision, where the device has it.
fn exponential(x: f32) -> f32 {
    return exp(x);
}

// exp(x) - 1 without cancellation: the series where it is short.
fn exp_less_one(x: f32) -> f32 {
    if (abs(x) > 0.5) {
        return exp(x) - 1.0;
    }
    let tail = 1.0 + x / 5.0 * (1.0 + x / 6.0 * (1.0 + x / 7.0 * (1.0 + x / 8.0)));
    return x * (1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0 * tail)));
}
// Tension that falls by e over each range.
fn law_traction(gap_here: real) -> real {
    let range = real(params.law_range);
    return law_factor * real(params.law_work) / range * exponential(-gap_here / range);
}

fn law_energy(gap_here: real) -> real {
    return -law_factor * real(params.law_work) * exponential(-gap_here / real(params.law_range));
}

fn law_slope(gap_here: real) -> real {
    return -law_traction(gap_here) / real(params.law_range);
}

// Ranges of a closing step beyond which its exponential may be past single precision. The gap it starts
// from then has next to no tension that could cancel.
const MOST_RANGES: real = 80.0;

// The gain of the traction over a step, to the rounding of the gain itself.
fn law_difference(gap_here: real, step: real) -> real {
    let ranges = -step / real(params.law_range);
    if (ranges > MOST_RANGES) {
        return law_traction(gap_here + step) - law_traction(gap_here);
    }
    return law_traction(gap_here) * exp_less_one(ranges);
}

// A law with a wall has no repulsion of its own.
fn law_repelling_gap(pressure: real) -> real {
    return 0.0;
}

// Asked of a law without a wall alone.
fn law_bend(gap_here: real) -> real {
    return 0.0;
}
// How kernels see the law where the unknown is the correction of an outer gap, and the pressure starts at the
// residual of the outer state: differences are taken without cancellation, so that all is relative to the
// correction. Twins: law/correction.rs.
fn open(correction: real) -> real {
    return known_gap + correction;
}

// The value of the unknown at which the surfaces touch.
fn closed_gap() -> real {
    return -known_gap;
}

fn traction(correction: real) -> real {
    return law_difference(known_gap, correction);
}

fn slope(correction: real) -> real {
    return law_slope(known_gap + correction);
}

// The scale of the stopping measure is the outer state's.
fn weighed(pressure: real) -> real {
    return 0.0;
}

fn corrects() -> bool {
    return true;
}

fn change(correction: real, moved: real) -> real {
    return law_difference(known_gap + correction, moved);
}

// The change of the energy to first order exactly, the rest by Simpson's rule over the step, which
// is short beside the range of a law; and the size of the first order.
fn energy_change(correction: real, moved: real) -> vec2<real> {
    let first = moved * traction(correction);
    let middle = change(correction, 0.5 * moved);
    let rest = moved / 6.0 * (4.0 * middle + change(correction, moved));
    return vec2<real>(first + rest, abs(first));
}
// A point as the kernels see it. Twins: kernel/constraint.rs.
struct Here {
    // The unknown, and the gap itself.
    gap: real,
    open: real,
    // p + mean_pressure.
    elastic: real,
    // The attraction.
    pull: real,
    // The slope of the energy to the side to which the point may move.
    y: real,
    free: bool,
    // By how much the unknown changes with the variable of the iteration.
    weight: real,
    // D.
    hardening: real,
}

// A point of its gap and p + mean_pressure; those of a pad have neither constraint nor law.
fn here_at(gap: real, elastic: real, in_domain: bool) -> Here {
    if (in_domain) {
        return state(gap, elastic);
    }
    return Here(gap, open(gap), elastic, real(0.0), elastic, true, real(1.0), real(0.0));
}

// What r is on a free point in exact balance: less than any rounding, and not 0.
const BALANCED: real = 1.2e-38;

// y on free points in the measure of the iteration's variable, 0 elsewhere and nowhere else.
fn projected_residual(here: Here) -> real {
    let residual = here.weight * here.y;
    return select(real(0.0), select(residual, BALANCED, residual == 0.0), here.free);
}

// What a point adds to the stopping measure.
struct Violation {
    violation: real,
    reaction: real,
    traction: real,
}

// A trial step, and whether the constraint cut it.
struct Tried {
    step: real,
    cut: bool,
}

// max(y, 0) where the point is closed.
fn reaction(open: real, y: real) -> real {
    return select(max(y, 0.0), real(0.0), open > 0.0);
}
// A gap that is not negative. Twins: kernel/constraint.rs, Unilateral.
const STORES_STEP: bool = false;

fn state(gap: real, elastic: real) -> Here {
    let open_here = open(gap);
    let pull = traction(gap);
    let y = elastic + pull;
    return Here(gap, open_here, elastic, pull, y, open_here > 0.0 || y < 0.0, real(1.0), real(0.0));
}

fn violation(here: Here) -> Violation {
    let off = min(here.y, here.open * real(params.stiffness_max));
    return Violation(off, reaction(here.open, here.y), here.pull);
}

fn preconditioned(here: Here, line: real) -> real {
    return select(real(0.0), line, here.free);
}

fn goes_down(open: real, y: real) -> bool {
    return false;
}

// s = s0 + correction (g + s0) with s0 = max(-g, moved).
fn trial_step(here: Here, moved: real, correction: real) -> Tried {
    let step = max(moved, -here.open);
    return Tried(step + correction * (here.open + step), here.open + moved < 0.0);
}

fn corrected_step(here: Here, step: real, correction: real, in_domain: bool) -> real {
    return step;
}

fn touches(open: real, step: real) -> bool {
    return step < 0.0;
}

// The gap after t of a step.
fn land(here: Here, step: real, t: real) -> real {
    // By what is left of the gap, which a cut makes exactly zero.
    let left = here.open + t * step;
    let lands = left <= 0.0 || (step < 0.0 && left < real(scalars.snap));
    return select(here.gap + t * step, closed_gap(), lands);
}

fn pressure_weight(here: Here) -> real {
    return here.open;
}

// The outer gap with a correction that was found in single precision, which closes the points where it
// undoes the outer gap as single precision has it.
fn corrected_gap(gap: real, correction: real) -> real {
    let moved = gap + correction;
    return select(moved, real(0.0), correction <= -real(f32(gap)) || moved < 0.0);
}

fn net_traction(here: Here) -> real {
    return here.pull;
}
// Twins: kernel/measure.rs.
fn residual_terms(here: Here, in_domain: bool) {
    if (!in_domain) {
        into_violation(wide(here.y) * wide(here.y));
        return;
    }
    let found = violation(here);
    let off = wide(found.violation);
    let pressed = wide(weighed(found.reaction));
    let pulled = wide(weighed(found.traction));
    into_violation(off * off);
    into_pressures((pressed * pressed + pulled * pulled));
    into_least_gap(wide(here.open));
    into_gap_squares(wide(here.gap) * wide(here.gap));
}
// Fills the rows of a transform with the projected residual and takes the stopping measure on the way.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let here = here_at(read_gap(index), read_pressure(index) + real(scalars.mean_pressure), in_domain);
    residual_terms(here, in_domain);
    let residual = projected_residual(here);
    write_projected_residual(index, residual);
    return residual;
}
var<workgroup> exchange: array<vec2<real>, 32>;
const LINES: u32 = 4u;
// Turns a value by a root of unity, and back by its conjugate.
fn turn(value: vec2<real>, root: vec2<real>) -> vec2<real> {
    return vec2<real>(value.x * root.x - value.y * root.y, value.x * root.y + value.y * root.x);
}

fn turn_back(value: vec2<real>, root: vec2<real>) -> vec2<real> {
    return vec2<real>(value.x * root.x + value.y * root.y, value.y * root.x - value.x * root.y);
}
@group(2) @binding(0) var<storage, read> roots: array<vec2<real>>;
@group(2) @binding(1) var<storage, read_write> work: array<vec2<real>>;
@compute @workgroup_size(4, 2)
fn load_residual(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
if (!gate_fresh()) { return; }
start_sums();
let line = place.x;
let thread = place.y;
if (group.x == 0u && index_in_group == 0u) { partials.transforms = partials.transforms + 1u; }
let pair = group.x * LINES + line;
let inside = pair < 4u;
var v0 = vec2<real>(0.0, 0.0);
var v1 = vec2<real>(0.0, 0.0);
var v2 = vec2<real>(0.0, 0.0);
var v3 = vec2<real>(0.0, 0.0);
if (inside) {
{ let j = thread + 0u;
let index0 = pair * 8u + (j + 0u);
let upper0 = fields_at(index0);
let lower0 = fields_at(index0 + 32u);
let index1 = pair * 8u + (j + 2u);
let upper1 = fields_at(index1);
let lower1 = fields_at(index1 + 32u);
{ let upper = visit(index0, upper0, 0.0);
v0 = vec2<real>(upper, visit(index0 + 32u, lower0, 0.0)); }
{ let upper = visit(index1, upper1, 0.0);
v1 = vec2<real>(upper, visit(index1 + 32u, lower1, 0.0)); }
let index2 = pair * 8u + (j + 4u);
let upper2 = fields_at(index2);
let lower2 = fields_at(index2 + 32u);
let index3 = pair * 8u + (j + 6u);
let upper3 = fields_at(index3);
let lower3 = fields_at(index3 + 32u);
{ let upper = visit(index2, upper2, 0.0);
v2 = vec2<real>(upper, visit(index2 + 32u, lower2, 0.0)); }
{ let upper = visit(index3, upper3, 0.0);
v3 = vec2<real>(upper, visit(index3 + 32u, lower3, 0.0)); }
}
}
{ let j = thread + 0u;
{
let even_sum = v0 + v2;
let even_difference = v0 - v2;
let odd_sum = v1 + v3;
let odd_difference = v1 - v3;
let turned = vec2<real>(odd_difference.y, -odd_difference.x);
v0 = even_sum + odd_sum;
v1 = even_difference + turned;
v2 = even_sum - odd_sum;
v3 = even_difference - turned;
}
}
{ let j = thread + 0u;
let start = (j / 1u) * 4u + j % 1u;
exchange[(start + 0u) * 4u + line] = v0;
exchange[(start + 1u) * 4u + line] = v1;
exchange[(start + 2u) * 4u + line] = v2;
exchange[(start + 3u) * 4u + line] = v3;
}
workgroupBarrier();
{ let j = thread + 0u;
v0 = exchange[((j + 0u)) * 4u + line];
v1 = exchange[((j + 4u)) * 4u + line];
}
{ let j = thread + 2u;
v2 = exchange[((j + 0u)) * 4u + line];
v3 = exchange[((j + 4u)) * 4u + line];
}
{ let j = thread + 0u;
let root = j % 4u;
v1 = turn(v1, roots[0u + root]);
{
let sum = v0 + v1;
v1 = v0 - v1;
v0 = sum;
}
}
{ let j = thread + 2u;
let root = j % 4u;
v3 = turn(v3, roots[0u + root]);
{
let sum = v2 + v3;
v3 = v2 - v3;
v2 = sum;
}
}
if (inside) {
{ let j = thread + 0u;
work[(j + 0u) * 4u + pair] = v0;
work[(j + 4u) * 4u + pair] = v1;
}
{ let j = thread + 2u;
work[(j + 0u) * 4u + pair] = v2;
work[(j + 4u) * 4u + pair] = v3;
}
}
hand_in(group.x, index_in_group);
}
