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
fn start_sums() {
sum_slope = part_of(wide(0.0));
sum_first_touch = part_of(params.infinity);
sum_largest_step = part_of(-params.infinity);
sum_least_step = part_of(params.infinity);
sum_cut = part_of(-params.infinity);
}
var<workgroup> group_values: array<part, 40>;
fn hand_in(group: u32, thread: u32) {
group_values[0u + thread] = sum_slope;
group_values[8u + thread] = sum_first_touch;
group_values[16u + thread] = sum_largest_step;
group_values[24u + thread] = sum_least_step;
group_values[32u + thread] = sum_cut;
workgroupBarrier();
if (thread < 4u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[4u + thread]);
group_values[8u + thread] = join_min(group_values[8u + thread], group_values[12u + thread]);
group_values[16u + thread] = join_max(group_values[16u + thread], group_values[20u + thread]);
group_values[24u + thread] = join_min(group_values[24u + thread], group_values[28u + thread]);
group_values[32u + thread] = join_max(group_values[32u + thread], group_values[36u + thread]);
}
workgroupBarrier();
if (thread < 2u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[2u + thread]);
group_values[8u + thread] = join_min(group_values[8u + thread], group_values[10u + thread]);
group_values[16u + thread] = join_max(group_values[16u + thread], group_values[18u + thread]);
group_values[24u + thread] = join_min(group_values[24u + thread], group_values[26u + thread]);
group_values[32u + thread] = join_max(group_values[32u + thread], group_values[34u + thread]);
}
workgroupBarrier();
if (thread < 1u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[1u + thread]);
group_values[8u + thread] = join_min(group_values[8u + thread], group_values[9u + thread]);
group_values[16u + thread] = join_max(group_values[16u + thread], group_values[17u + thread]);
group_values[24u + thread] = join_min(group_values[24u + thread], group_values[25u + thread]);
group_values[32u + thread] = join_max(group_values[32u + thread], group_values[33u + thread]);
}
workgroupBarrier();
if (thread == 0u) {
partials.values[0u + group] = group_values[0u];
partials.values[1u + group] = group_values[8u];
partials.values[2u + group] = group_values[16u];
partials.values[3u + group] = group_values[24u];
partials.values[4u + group] = group_values[32u];
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
@group(1) @binding(2) var<storage, read> field_direction: array<real>;
fn read_direction(index: u32) -> real { return fields_here.direction; }
fn read_step(index: u32) -> real { return 0.0; }
fn write_step(index: u32, value: real) {}
const law_factor: real = 1.0;
struct Fields { gap: real, pressure: real, direction: real,  }
var<private> fields_here: Fields;
fn fields_at(index: u32) -> Fields { return Fields(field_gap[index], field_pressure[index], field_direction[index], ); }
fn visit(index: u32, fields: Fields, line: real) -> real { fields_here = fields; return at(index, in_domain(index), line); }
const WIDTH: u32 = 8u;
const HEIGHT: u32 = 8u;
fn into_elastic_slope(term: wide) {}
fn into_change_at_first(term: wide) {}
fn into_energy_change(term: wide) {}
fn into_energy_size(term: wide) {}
// Constant tension up to about the range, then linear to zero over the width `taper` centred on it.
fn law_traction(gap_here: real) -> real {
    let peak = law_factor * real(params.law_peak);
    let range = real(params.law_range);
    let taper = real(params.law_taper);
    if (taper > 0.0) {
        return peak * clamp((range - gap_here) / taper + 0.5, 0.0, 1.0);
    }
    return select(0.0, peak, gap_here < range);
}

fn law_energy(gap_here: real) -> real {
    let peak = law_factor * real(params.law_peak);
    let range = real(params.law_range);
    let taper = real(params.law_taper);
    let half = 0.5 * taper;
    if (gap_here <= range - half) {
        return -peak * (range - gap_here);
    }
    if (gap_here < range + half) {
        let left = range + half - gap_here;
        return -peak * left * left / (2.0 * taper);
    }
    return 0.0;
}

fn law_slope(gap_here: real) -> real {
    let range = real(params.law_range);
    let taper = real(params.law_taper);
    let half = 0.5 * taper;
    if (gap_here > range - half && gap_here < range + half) {
        return -law_factor * real(params.law_peak) / taper;
    }
    return 0.0;
}

// The gain of the traction over a step, to the rounding of the gain itself: only the part of the way
// that lies on the taper counts.
fn law_difference(gap_here: real, step: real) -> real {
    let taper = real(params.law_taper);
    if (taper <= 0.0) {
        return law_traction(gap_here + step) - law_traction(gap_here);
    }
    let left = (real(params.law_range) - gap_here) / taper + 0.5;
    let moved = step / taper;
    var lost = min(max(moved, left - 1.0), left);
    if (left > 1.0) {
        lost = clamp(moved - (left - 1.0), 0.0, 1.0);
    } else if (left < 0.0) {
        lost = -clamp(left - moved, 0.0, 1.0);
    }
    return -law_factor * real(params.law_peak) * lost;
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
// A pressure that is limited by the hardness. Below zero a gap is the depth of plastic indentation. Twins:
// kernel/constraint.rs, HardnessLimit.
const STORES_STEP: bool = false;

fn state(gap: real, elastic: real) -> Here {
    let pull = traction(max(gap, 0.0));
    let excess = elastic - real(params.hardness);
    let y = elastic + pull;
    let above = gap > 0.0 || y < 0.0;
    let yields = gap < 0.0 || (!above && excess > 0.0);
    let rests = select(real(0.0), y, above);
    return Here(gap, gap, elastic, pull, select(rests, excess, yields), yields || above, real(1.0), real(0.0));
}

fn violation(here: Here) -> Violation {
    let y = here.elastic + here.pull;
    // The middle one of the two slopes and the gap.
    let off = max(min(y, here.gap * real(params.stiffness_max)), here.elastic - real(params.hardness));
    return Violation(off, reaction(here.gap, y), here.pull);
}

fn preconditioned(here: Here, line: real) -> real {
    return select(real(0.0), line, here.free);
}

// Whether a point is below zero or may only go there.
fn goes_down(open: real, y: real) -> bool {
    return open < 0.0 || (open == 0.0 && y > 0.0);
}

// s = s0 + correction (g + s0) with s0 the way to clip(g + moved); below zero with the opposite sign of
// the correction, so that a prescribed mean is kept on either side.
fn trial_step(here: Here, moved: real, correction: real) -> Tried {
    if (goes_down(here.open, here.y)) {
        let down = min(moved, -here.open);
        return Tried(down - correction * (here.open + down), here.open + moved > 0.0);
    }
    let up = max(moved, -here.open);
    return Tried(up + correction * (here.open + up), here.open + moved < 0.0);
}

fn corrected_step(here: Here, step: real, correction: real, in_domain: bool) -> real {
    return step;
}

fn touches(open: real, step: real) -> bool {
    return (open >= 0.0 && step < 0.0) || (open < 0.0 && step > 0.0);
}

// The gap after t of a step: no point crosses zero.
fn land(here: Here, step: real, t: real) -> real {
    let moved = here.gap + t * step;
    let snap = real(scalars.snap);
    if (goes_down(here.gap, here.y)) {
        return select(moved, closed_gap(), moved > 0.0 || (step > 0.0 && moved > -snap));
    }
    return select(moved, closed_gap(), moved < 0.0 || (step < 0.0 && moved < snap));
}

fn pressure_weight(here: Here) -> real {
    return abs(here.gap);
}

fn corrected_gap(gap: real, correction: real) -> real {
    return gap + correction;
}

fn net_traction(here: Here) -> real {
    return select(here.pull, -real(params.hardness), here.gap < 0.0);
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
// Fills the rows of a transform with the trial step brought back to the prescribed mean gap.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let correction = real(scalars.mean_gap_correction);
    // A trial that nothing brings back is lost: one that moves and does not descend.
    if (!STORES_STEP && !(correction > -1.0 && correction < 1.0)) {
        into_largest_step(wide(1.0));
        into_cut(wide(0.0));
        return 0.0;
    }
    let here = here_at(read_gap(index), read_pressure(index) + real(scalars.mean_pressure), in_domain);
    if (STORES_STEP) {
        let step = corrected_step(here, read_step(index), correction, in_domain);
        write_step(index, step);
        trial_terms(Tried(step, false), here, in_domain);
        smooth_trial_terms(here, step, in_domain);
        return step;
    }
    let tried = step_at(here, real(scalars.trial_length) * read_direction(index), correction, in_domain);
    trial_terms(tried, here, in_domain);
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
fn load_trial(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
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
