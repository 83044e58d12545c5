alias real = f32;
// declarations.wgsl
// common.wgsl
@group(0) @binding(1) var<storage, read> scalars: Scalars;
// gate.wgsl
// sums.wgsl
// reduce.wgsl
var<private> sum_violation: part;
fn into_violation(term: wide) { sum_violation = add(sum_violation, term); }
var<private> sum_pressures: part;
fn into_pressures(term: wide) { sum_pressures = add(sum_pressures, term); }
var<private> sum_least_gap: part;
fn into_least_gap(term: wide) { sum_least_gap = least(sum_least_gap, term); }
var<private> sum_gap_squares: part;
fn into_gap_squares(term: wide) { sum_gap_squares = add(sum_gap_squares, term); }
var<private> sum_direction_change: part;
fn into_direction_change(term: wide) { sum_direction_change = add(sum_direction_change, term); }
var<private> sum_direction_residual: part;
fn into_direction_residual(term: wide) { sum_direction_residual = add(sum_direction_residual, term); }
fn start_sums() {
sum_violation = part_of(wide(0.0));
sum_pressures = part_of(wide(0.0));
sum_least_gap = part_of(params.infinity);
sum_gap_squares = part_of(wide(0.0));
sum_direction_change = part_of(wide(0.0));
sum_direction_residual = part_of(wide(0.0));
}
var<workgroup> group_values: array<part, 48>;
fn hand_in(group: u32, thread: u32) {
group_values[0u + thread] = sum_violation;
group_values[8u + thread] = sum_pressures;
group_values[16u + thread] = sum_least_gap;
group_values[24u + thread] = sum_gap_squares;
group_values[32u + thread] = sum_direction_change;
group_values[40u + thread] = sum_direction_residual;
workgroupBarrier();
if (thread < 4u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[4u + thread]);
group_values[8u + thread] = join_add(group_values[8u + thread], group_values[12u + thread]);
group_values[16u + thread] = join_min(group_values[16u + thread], group_values[20u + thread]);
group_values[24u + thread] = join_add(group_values[24u + thread], group_values[28u + thread]);
group_values[32u + thread] = join_add(group_values[32u + thread], group_values[36u + thread]);
group_values[40u + thread] = join_add(group_values[40u + thread], group_values[44u + thread]);
}
workgroupBarrier();
if (thread < 2u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[2u + thread]);
group_values[8u + thread] = join_add(group_values[8u + thread], group_values[10u + thread]);
group_values[16u + thread] = join_min(group_values[16u + thread], group_values[18u + thread]);
group_values[24u + thread] = join_add(group_values[24u + thread], group_values[26u + thread]);
group_values[32u + thread] = join_add(group_values[32u + thread], group_values[34u + thread]);
group_values[40u + thread] = join_add(group_values[40u + thread], group_values[42u + thread]);
}
workgroupBarrier();
if (thread < 1u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[1u + thread]);
group_values[8u + thread] = join_add(group_values[8u + thread], group_values[9u + thread]);
group_values[16u + thread] = join_min(group_values[16u + thread], group_values[17u + thread]);
group_values[24u + thread] = join_add(group_values[24u + thread], group_values[25u + thread]);
group_values[32u + thread] = join_add(group_values[32u + thread], group_values[33u + thread]);
group_values[40u + thread] = join_add(group_values[40u + thread], group_values[41u + thread]);
}
workgroupBarrier();
if (thread == 0u) {
partials.values[0u + group] = group_values[0u];
partials.values[1u + group] = group_values[8u];
partials.values[2u + group] = group_values[16u];
partials.values[3u + group] = group_values[24u];
partials.values[4u + group] = group_values[32u];
partials.values[5u + group] = group_values[40u];
}
}
fn row_of(index: u32) -> u32 {
return index / 8u;
}
fn in_domain(index: u32) -> bool { return true; }
@group(1) @binding(0) var<storage, read> field_direction: array<real>;
fn read_direction(index: u32) -> real { return fields_here.direction; }
@group(1) @binding(1) var<storage, read_write> field_gap: array<real>;
fn read_gap(index: u32) -> real { return fields_here.gap; }
fn write_gap(index: u32, value: real) { field_gap[index] = value; }
@group(1) @binding(2) var<storage, read_write> field_pressure: array<real>;
fn read_pressure(index: u32) -> real { return fields_here.pressure; }
fn write_pressure(index: u32, value: real) { field_pressure[index] = value; }
@group(1) @binding(3) var<storage, read_write> field_projected_residual: array<real>;
fn read_projected_residual(index: u32) -> real { return fields_here.projected_residual; }
fn write_projected_residual(index: u32, value: real) { field_projected_residual[index] = value; }
@group(1) @binding(4) var<storage, read_write> field_previous_residual: array<real>;
fn write_previous_residual(index: u32, value: real) { field_previous_residual[index] = value; }
fn read_step(index: u32) -> real { return 0.0; }
fn write_step(index: u32, value: real) {}
const law_factor: real = 1.0;
struct Fields { direction: real, gap: real, pressure: real, projected_residual: real,  }
var<private> fields_here: Fields;
fn fields_at(index: u32) -> Fields { return Fields(field_direction[index], field_gap[index], field_pressure[index], field_projected_residual[index], ); }
fn visit(index: u32, fields: Fields, line: real) -> real { fields_here = fields; return at(index, in_domain(index), line); }
const WIDTH: u32 = 8u;
const HEIGHT: u32 = 8u;
const STORED: bool = true;
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
// How kernels see the law where the unknown is the gap itself. Twins: law/mod.rs,
// law/adhesion_map.rs.
fn open(gap: real) -> real {
    return gap;
}

// The value of the unknown at which the surfaces touch.
fn closed_gap() -> real {
    return 0.0;
}

fn traction(gap: real) -> real {
    return law_traction(gap);
}

fn slope(gap: real) -> real {
    return law_slope(gap);
}

// What of a pressure enters the scale of the stopping measure.
fn weighed(pressure: real) -> real {
    return pressure;
}

fn corrects() -> bool {
    return false;
}

fn change(gap: real, moved: real) -> real {
    return law_traction(gap + moved) - law_traction(gap);
}

// The change of the energy of adhesion, and the size of what it was taken from.
fn energy_change(gap: real, moved: real) -> vec2<real> {
    let energy = law_energy(gap);
    return vec2<real>(law_energy(gap + moved) - energy, abs(energy));
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
// Twins: kernel/trial.rs. The new direction: zero where the point is not free.
fn new_direction(z: real, direction: real, free: bool) -> real {
    if (!free) {
        return 0.0;
    }
    return real(scalars.descent_factor) * z + real(scalars.beta) * direction + real(scalars.mean_gap_shift);
}

// The trial step of a point; a pad has no constraint.
fn step_at(here: Here, moved: real, correction: real, in_domain: bool) -> Tried {
    if (in_domain) {
        return trial_step(here, moved, correction);
    }
    return Tried(moved, false);
}
// A point after a step, and its projected residual before it. Twins: kernel/update.rs.
struct Moved {
    gap: real,
    pressure: real,
    previous: real,
}

// A point after the step along a direction, or by the kept trial step, which the elastic pressure `answer`s.
fn step_from(gap: real, pressure: real, moved: real, answer: real, in_domain: bool) -> Moved {
    let here = here_at(gap, pressure + real(scalars.mean_pressure), in_domain);
    let previous = projected_residual(here);
    // A lost trial leaves all as it is.
    if (scalars.accepted == 0u) {
        return Moved(gap, pressure, previous);
    }
    var step = moved;
    if (!STORES_STEP) {
        let way = real(scalars.trial_length) * moved;
        step = step_at(here, way, real(scalars.mean_gap_correction), in_domain).step;
    }
    let t = real(scalars.step);
    var after = gap + t * step;
    if (in_domain) {
        after = land(here, step, t);
    }
    return Moved(after, pressure + t * answer, previous);
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
// Takes K s and steps, g += t s, p += t K s; then fills the rows of a transform with the new projected residual.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let direction = read_direction(index);
    let way = select(direction, read_step(index), STORES_STEP);
    let moved = step_from(read_gap(index), read_pressure(index), way, line, in_domain);
    write_gap(index, moved.gap);
    write_pressure(index, moved.pressure);
    // What is stored is of the state before the step.
    let previous = select(moved.previous, read_projected_residual(index), STORED);
    write_previous_residual(index, previous);
    let here = here_at(moved.gap, moved.pressure + real(scalars.mean_pressure), in_domain);
    residual_terms(here, in_domain);
    let residual = projected_residual(here);
    into_direction_change(wide(direction) * (wide(residual) - wide(previous)));
    into_direction_residual(wide(direction) * wide(residual));
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
fn update_state(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
if (!gate_running()) { return; }
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
v0 = work[(j + 0u) * 4u + pair];
v1 = work[(j + 4u) * 4u + pair];
}
{ let j = thread + 2u;
v2 = work[(j + 0u) * 4u + pair];
v3 = work[(j + 4u) * 4u + pair];
}
}
{ let j = thread + 0u;
{
let sum = v0 + v1;
v1 = v0 - v1;
v0 = sum;
}
}
{ let j = thread + 2u;
{
let sum = v2 + v3;
v3 = v2 - v3;
v2 = sum;
}
}
{ let j = thread + 0u;
let start = (j / 1u) * 2u + j % 1u;
exchange[(start + 0u) * 4u + line] = v0;
exchange[(start + 1u) * 4u + line] = v1;
}
{ let j = thread + 2u;
let start = (j / 1u) * 2u + j % 1u;
exchange[(start + 0u) * 4u + line] = v2;
exchange[(start + 1u) * 4u + line] = v3;
}
workgroupBarrier();
{ let j = thread + 0u;
v0 = exchange[((j + 0u)) * 4u + line];
v1 = exchange[((j + 2u)) * 4u + line];
v2 = exchange[((j + 4u)) * 4u + line];
v3 = exchange[((j + 6u)) * 4u + line];
}
{ let j = thread + 0u;
let root = j % 2u;
v1 = turn_back(v1, roots[4u + root]);
v2 = turn_back(v2, roots[6u + root]);
v3 = turn_back(v3, roots[8u + root]);
{
let even_sum = v0 + v2;
let even_difference = v0 - v2;
let odd_sum = v1 + v3;
let odd_difference = v1 - v3;
let turned = vec2<real>(-odd_difference.y, odd_difference.x);
v0 = even_sum + odd_sum;
v1 = even_difference + turned;
v2 = even_sum - odd_sum;
v3 = even_difference - turned;
}
}
if (inside) {
{ let j = thread + 0u;
let index0 = pair * 8u + (j + 0u);
let upper0 = fields_at(index0);
let lower0 = fields_at(index0 + 32u);
let index1 = pair * 8u + (j + 2u);
let upper1 = fields_at(index1);
let lower1 = fields_at(index1 + 32u);
visit(index0, upper0, v0.x);
visit(index0 + 32u, lower0, v0.y);
visit(index1, upper1, v1.x);
visit(index1 + 32u, lower1, v1.y);
let index2 = pair * 8u + (j + 4u);
let upper2 = fields_at(index2);
let lower2 = fields_at(index2 + 32u);
let index3 = pair * 8u + (j + 6u);
let upper3 = fields_at(index3);
let lower3 = fields_at(index3 + 32u);
visit(index2, upper2, v2.x);
visit(index2 + 32u, lower2, v2.y);
visit(index3, upper3, v3.x);
visit(index3 + 32u, lower3, v3.y);
}
}
hand_in(group.x, index_in_group);
}
