alias real = f32;
// declarations.wgsl
// common.wgsl
@group(0) @binding(1) var<storage, read> scalars: Scalars;
// gate.wgsl
// sums.wgsl
// reduce.wgsl
var<private> sum_slope: part;
fn into_slope(term: wide) { sum_slope = add(sum_slope, term); }
var<private> sum_first_touch: part;
fn into_first_touch(term: wide) { sum_first_touch = least(sum_first_touch, term); }
var<private> sum_largest_step: part;
fn into_largest_step(term: wide) { sum_largest_step = most(sum_largest_step, term); }
var<private> sum_least_step: part;
fn into_least_step(term: wide) { sum_least_step = least(sum_least_step, term); }
var<private> sum_cut: part;
fn into_cut(term: wide) { sum_cut = most(sum_cut, term); }
var<private> sum_elastic_slope: part;
fn into_elastic_slope(term: wide) { sum_elastic_slope = add(sum_elastic_slope, term); }
var<private> sum_change_at_first: part;
fn into_change_at_first(term: wide) { sum_change_at_first = add(sum_change_at_first, term); }
var<private> sum_energy_change: part;
fn into_energy_change(term: wide) { sum_energy_change = add(sum_energy_change, term); }
var<private> sum_energy_size: part;
fn into_energy_size(term: wide) { sum_energy_size = add(sum_energy_size, term); }
fn start_sums() {
sum_slope = part_of(wide(0.0));
sum_first_touch = part_of(params.infinity);
sum_largest_step = part_of(-params.infinity);
sum_least_step = part_of(params.infinity);
sum_cut = part_of(-params.infinity);
sum_elastic_slope = part_of(wide(0.0));
sum_change_at_first = part_of(wide(0.0));
sum_energy_change = part_of(wide(0.0));
sum_energy_size = part_of(wide(0.0));
}
var<workgroup> group_values: array<part, 72>;
fn hand_in(group: u32, thread: u32) {
group_values[0u + thread] = sum_slope;
group_values[8u + thread] = sum_first_touch;
group_values[16u + thread] = sum_largest_step;
group_values[24u + thread] = sum_least_step;
group_values[32u + thread] = sum_cut;
group_values[40u + thread] = sum_elastic_slope;
group_values[48u + thread] = sum_change_at_first;
group_values[56u + thread] = sum_energy_change;
group_values[64u + thread] = sum_energy_size;
workgroupBarrier();
if (thread < 4u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[4u + thread]);
group_values[8u + thread] = join_min(group_values[8u + thread], group_values[12u + thread]);
group_values[16u + thread] = join_max(group_values[16u + thread], group_values[20u + thread]);
group_values[24u + thread] = join_min(group_values[24u + thread], group_values[28u + thread]);
group_values[32u + thread] = join_max(group_values[32u + thread], group_values[36u + thread]);
group_values[40u + thread] = join_add(group_values[40u + thread], group_values[44u + thread]);
group_values[48u + thread] = join_add(group_values[48u + thread], group_values[52u + thread]);
group_values[56u + thread] = join_add(group_values[56u + thread], group_values[60u + thread]);
group_values[64u + thread] = join_add(group_values[64u + thread], group_values[68u + thread]);
}
workgroupBarrier();
if (thread < 2u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[2u + thread]);
group_values[8u + thread] = join_min(group_values[8u + thread], group_values[10u + thread]);
group_values[16u + thread] = join_max(group_values[16u + thread], group_values[18u + thread]);
group_values[24u + thread] = join_min(group_values[24u + thread], group_values[26u + thread]);
group_values[32u + thread] = join_max(group_values[32u + thread], group_values[34u + thread]);
group_values[40u + thread] = join_add(group_values[40u + thread], group_values[42u + thread]);
group_values[48u + thread] = join_add(group_values[48u + thread], group_values[50u + thread]);
group_values[56u + thread] = join_add(group_values[56u + thread], group_values[58u + thread]);
group_values[64u + thread] = join_add(group_values[64u + thread], group_values[66u + thread]);
}
workgroupBarrier();
if (thread < 1u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[1u + thread]);
group_values[8u + thread] = join_min(group_values[8u + thread], group_values[9u + thread]);
group_values[16u + thread] = join_max(group_values[16u + thread], group_values[17u + thread]);
group_values[24u + thread] = join_min(group_values[24u + thread], group_values[25u + thread]);
group_values[32u + thread] = join_max(group_values[32u + thread], group_values[33u + thread]);
group_values[40u + thread] = join_add(group_values[40u + thread], group_values[41u + thread]);
group_values[48u + thread] = join_add(group_values[48u + thread], group_values[49u + thread]);
group_values[56u + thread] = join_add(group_values[56u + thread], group_values[57u + thread]);
group_values[64u + thread] = join_add(group_values[64u + thread], group_values[65u + thread]);
}
workgroupBarrier();
if (thread == 0u) {
partials.values[0u + group] = group_values[0u];
partials.values[1u + group] = group_values[8u];
partials.values[2u + group] = group_values[16u];
partials.values[3u + group] = group_values[24u];
partials.values[4u + group] = group_values[32u];
partials.values[5u + group] = group_values[40u];
partials.values[6u + group] = group_values[48u];
partials.values[7u + group] = group_values[56u];
partials.values[8u + group] = group_values[64u];
}
}
fn row_of(index: u32) -> u32 {
return index / 8u;
}
fn in_domain(index: u32) -> bool { return true; }
@group(1) @binding(0) var<storage, read> field_gap: array<real>;
fn read_gap(index: u32) -> real { return fields_here.gap; }
@group(1) @binding(1) var<storage, read> field_pressure: array<real>;
fn read_pressure(index: u32) -> real { return fields_here.pressure; }
@group(1) @binding(2) var<storage, read_write> field_direction: array<real>;
fn read_direction(index: u32) -> real { return fields_here.direction; }
fn write_direction(index: u32, value: real) { field_direction[index] = value; }
@group(1) @binding(3) var<storage, read_write> field_step: array<real>;
fn write_step(index: u32, value: real) { field_step[index] = value; }
fn read_heights_pressure(index: u32) -> real { return 0.0; }
fn write_heights_pressure(index: u32, value: real) {}
const law_factor: real = 1.0;
struct Fields { gap: real, pressure: real, direction: real,  }
var<private> fields_here: Fields;
fn fields_at(index: u32) -> Fields { return Fields(field_gap[index], field_pressure[index], field_direction[index], ); }
fn visit(index: u32, fields: Fields, line: real) -> real { fields_here = fields; return at(index, in_domain(index), line); }
const WIDTH: u32 = 8u;
const HEIGHT: u32 = 8u;
const LINEAR: bool = false;
fn into_closing(term: wide) {}
fn into_step_sum(term: wide) {}
fn into_gap_sum(term: wide) {}
fn into_gap_slope(term: wide) {}
fn into_step_gap_curvature(term: wide) {}
fn into_gap_curvature(term: wide) {}
// The 9-3 law: sigma = (8 w / 3 eps) (r^3 - r^9) with r = eps / (gap + eps).

// Nearer than this share of the range r^9 would overflow what any load can balance.
const LAW_NEAREST: real = 0.02;

fn law_ratio(gap_here: real) -> real {
    let range = real(params.law_range);
    return range / max(gap_here + range, LAW_NEAREST * range);
}

fn law_traction(gap_here: real) -> real {
    let r = law_ratio(gap_here);
    let cube = r * r * r;
    let scale = 8.0 / 3.0 * law_factor * real(params.law_work) / real(params.law_range);
    return scale * (cube - cube * cube * cube);
}

fn law_energy(gap_here: real) -> real {
    let r = law_ratio(gap_here);
    let square = r * r;
    let eighth = square * square * square * square;
    return -law_factor * real(params.law_work) * (4.0 / 3.0 * square - 1.0 / 3.0 * eighth);
}

fn law_slope(gap_here: real) -> real {
    let range = real(params.law_range);
    let r = law_ratio(gap_here);
    let fourth = r * r * r * r;
    let tenth = fourth * fourth * r * r;
    return 8.0 / 3.0 * law_factor * real(params.law_work) / (range * range) * (9.0 * tenth - 3.0 * fourth);
}

fn law_bend(gap_here: real) -> real {
    let range = real(params.law_range);
    let r = law_ratio(gap_here);
    let square = r * r;
    let fifth = square * square * r;
    let scale = 8.0 / 3.0 * law_factor * real(params.law_work) / (range * range * range);
    return scale * fifth * (12.0 - 90.0 * (square * square * square));
}

// The gain of the traction over a step, to the rounding of the gain itself: by how much r^3 and r^9
// grow, as shares of themselves.
fn law_difference(gap_here: real, step: real) -> real {
    let range = real(params.law_range);
    let distance_here = gap_here + range;
    let nearest = LAW_NEAREST * range;
    if (distance_here <= nearest || distance_here + step <= nearest) {
        return law_traction(gap_here + step) - law_traction(gap_here);
    }
    let x = step / distance_here;
    let third = -x * (3.0 + x * (3.0 + x)) / ((1.0 + x) * (1.0 + x) * (1.0 + x));
    let ninth = third * (3.0 + third * (3.0 + third));
    let r = law_ratio(gap_here);
    let cube = r * r * r;
    let scale = 8.0 / 3.0 * law_factor * real(params.law_work) / range;
    return scale * (cube * third - cube * cube * cube * ninth);
}

// A gap, just below that of zero force or deeper, at which the law repels by at least this pressure, from the
// repulsive power alone. It bounds Newton's method, for which a root in single precision will do.
fn law_repelling_gap(pressure: real) -> real {
    let range = real(params.law_range);
    let load = max(pressure * 0.375 * range / (law_factor * real(params.law_work)), 0.0);
    return range * (real(pow(f32(1.3 * load + 2.5), -1.0 / 9.0)) - 1.0);
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
// A law that repels by itself: no constraint, and another variable in which its steep core is not stiff.
// Below the gap of largest tension the iteration works in v = g - (sigma_max - sigma(g))/k, in which
// the core is no stiffer than k. With D = max(sigma'(g), 0): dg = S2 dv, S2 = k/(k + D).
// Twins: kernel/smooth.rs, kernel/constraint.rs, kernel/seek.rs.
const STORES_STEP: bool = true;
const MOST_STEPS: u32 = 25u;
// A step of Halley's method leaves an error of a constant times its third power. In shares of the distance the constant is 7
// where the core is steep, so that the step after one of this many cube roots of the rounding error would be below rounding.
const LAST_STEP: f32 = 0.4;

// D.
fn hardening(gap: real) -> real {
    return max(slope(gap), 0.0);
}

// S2.
fn share(gap: real) -> real {
    let stiffness = real(params.smooth_stiffness);
    return stiffness / (stiffness + hardening(gap));
}

// v.
fn variable(gap: real) -> real {
    if (gap < real(params.law_peak_gap)) {
        return gap - (law_factor * real(params.law_peak) - traction(gap)) / real(params.smooth_stiffness);
    }
    return gap;
}

// The gap at a value of v by the tangent at another gap.
fn by_tangent(goal: real, gap: real) -> real {
    return min(gap - (variable(gap) - goal) * share(gap), real(params.law_peak_gap));
}

// One step of Halley's method from a gap to that at a value of v, within the core: with v' and v'' there.
fn by_halley(goal: real, gap: real, bound: real) -> real {
    let error = variable(gap) - goal;
    let stiffness = real(params.smooth_stiffness);
    let slope_here = 1.0 + hardening(gap) / stiffness;
    let half_bend = 0.5 * law_bend(gap) / stiffness;
    let next = gap - error * slope_here / (slope_here * slope_here - error * half_bend);
    return min(max(next, bound), real(params.law_peak_gap));
}

// The gap at a value of v, from the tangent at `gap`.
fn gap_at(goal: real, gap: real) -> real {
    let peak_gap = real(params.law_peak_gap);
    if (goal >= peak_gap) {
        return goal;
    }
    // v is concave here, so that the tangent leads to the left of what is sought. A start that is too far is bounded by what
    // the repulsive power alone gives.
    let load = real(params.smooth_stiffness) * (peak_gap - goal) - law_factor * real(params.law_peak);
    var x = max(by_tangent(goal, gap), law_repelling_gap(load));
    let bound = x;
    let last_step = LAST_STEP * pow(f32(params.epsilon), 1.0 / 3.0);
    for (var count = 0u; count < MOST_STEPS; count = count + 1u) {
        let next = by_halley(goal, x, bound);
        let moved = abs(next - x);
        x = next;
        if (moved <= real(last_step) * (x + real(params.law_range))) {
            break;
        }
    }
    return x;
}

fn state(gap: real, elastic: real) -> Here {
    let pull = traction(gap);
    let stiffness = real(params.smooth_stiffness);
    let hardening_here = hardening(gap);
    let weight = stiffness / (stiffness + hardening_here);
    return Here(gap, open(gap), elastic, pull, elastic + pull, true, weight, hardening_here);
}

fn violation(here: Here) -> Violation {
    return Violation(here.y, real(0.0), here.pull);
}

// z / S2: the long-range part, and the local part that the core's own stiffness answers.
fn preconditioned(here: Here, line: real) -> real {
    let stiffness = real(params.smooth_stiffness);
    return line + here.hardening / stiffness * here.y / (here.hardening + stiffness);
}

fn goes_down(open: real, y: real) -> bool {
    return false;
}

// The change of g as v moves.
fn trial_step(here: Here, moved: real, correction: real) -> Tried {
    if (corrects()) {
        // A correction is short: v follows its slope.
        return Tried(here.weight * moved, false);
    }
    return Tried(gap_at(variable(here.gap) + moved, here.gap) - here.gap, false);
}

fn corrected_step(here: Here, step: real, correction: real, in_domain: bool) -> real {
    if (in_domain) {
        return step - correction * share(here.gap + step);
    }
    return step - correction;
}

fn touches(open: real, step: real) -> bool {
    return false;
}

fn land(here: Here, step: real, t: real) -> real {
    return here.gap + t * step;
}

fn pressure_weight(here: Here) -> real {
    return here.weight;
}

fn corrected_gap(gap: real, correction: real) -> real {
    return gap + correction;
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
// The terms of a trial step. Twins: kernel/trial.rs.
fn trial_terms(tried: Tried, here: Here, in_domain: bool) {
    let s = wide(tried.step);
    into_slope(s * wide(here.y));
    if (in_domain && touches(here.open, tried.step)) {
        into_first_touch(wide(here.open) / -s);
    }
    into_largest_step(s);
    into_least_step(s);
    into_cut(select(wide(0.0), wide(1.0), tried.cut));
}

// What a smooth law's trial asks besides: step length 1, as a search would evaluate it.
fn smooth_trial_terms(here: Here, step: real, in_domain: bool) {
    let s = wide(step);
    into_elastic_slope(s * wide(here.elastic));
    if (!in_domain) {
        return;
    }
    let energy = energy_change(here.gap, step);
    into_change_at_first(wide(change(here.gap, step)) * s);
    into_energy_change(wide(energy.x));
    into_energy_size(wide(energy.y));
}
// The terms of a trial s0 before the mean gap is restored; `bent` is K g. Twins: kernel/trial.rs.
fn linear_trial_terms(tried: Tried, here: Here, bent: real) {
    let s = wide(tried.step);
    let g = wide(here.open);
    into_slope(s * wide(here.y));
    if (here.open > 0.0) {
        into_closing(wide(-tried.step / here.open));
    }
    into_largest_step(s);
    into_least_step(s);
    into_cut(select(wide(0.0), wide(1.0), tried.cut));
    into_step_sum(s);
    into_gap_sum(g);
    into_gap_slope(g * wide(here.y));
    into_step_gap_curvature(s * wide(bent));
    into_gap_curvature(g * wide(bent));
}
// Turns the direction by the retained rows of z and fills the rows of a transform with the trial step.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let pressure = read_pressure(index);
    let here = here_at(read_gap(index), pressure + real(scalars.mean_pressure), in_domain);
    let d = new_direction(line, read_direction(index), here.free);
    write_direction(index, d);
    let tried = step_at(here, real(scalars.trial_length) * d, 0.0, in_domain);
    if (LINEAR) {
        linear_trial_terms(tried, here, pressure - read_heights_pressure(index));
    } else {
        trial_terms(tried, here, in_domain);
    }
    if (STORES_STEP) {
        write_step(index, tried.step);
        smooth_trial_terms(here, tried.step, in_domain);
    }
    return tried.step;
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
fn trial(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
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
v1 = work[(j + 2u) * 4u + pair];
v2 = work[(j + 4u) * 4u + pair];
v3 = work[(j + 6u) * 4u + pair];
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
{ let upper = visit(index0, upper0, v0.x);
v0 = vec2<real>(upper, visit(index0 + 32u, lower0, v0.y)); }
{ let upper = visit(index1, upper1, v1.x);
v1 = vec2<real>(upper, visit(index1 + 32u, lower1, v1.y)); }
let index2 = pair * 8u + (j + 4u);
let upper2 = fields_at(index2);
let lower2 = fields_at(index2 + 32u);
let index3 = pair * 8u + (j + 6u);
let upper3 = fields_at(index3);
let lower3 = fields_at(index3 + 32u);
{ let upper = visit(index2, upper2, v2.x);
v2 = vec2<real>(upper, visit(index2 + 32u, lower2, v2.y)); }
{ let upper = visit(index3, upper3, v3.x);
v3 = vec2<real>(upper, visit(index3 + 32u, lower3, v3.y)); }
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
