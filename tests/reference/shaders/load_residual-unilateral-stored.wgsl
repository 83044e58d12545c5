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
fn start_sums() {
sum_violation = part_of(wide(0.0));
sum_pressures = part_of(wide(0.0));
sum_least_gap = part_of(params.infinity);
sum_gap_squares = part_of(wide(0.0));
}
var<workgroup> group_values: array<part, 1024>;
fn hand_in(group: u32, thread: u32) {
group_values[0u + thread] = sum_violation;
group_values[256u + thread] = sum_pressures;
group_values[512u + thread] = sum_least_gap;
group_values[768u + thread] = sum_gap_squares;
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
partials.values[0u + group] = group_values[0u];
partials.values[1u + group] = group_values[256u];
partials.values[2u + group] = group_values[512u];
partials.values[3u + group] = group_values[768u];
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
@group(1) @binding(2) var<storage, read_write> field_projected_residual: array<real>;
fn write_projected_residual(index: u32, value: real) { field_projected_residual[index] = value; }
const law_factor: real = 1.0;
struct Fields { gap: real, pressure: real,  }
var<private> fields_here: Fields;
fn fields_at(index: u32) -> Fields { return Fields(field_gap[index], field_pressure[index], ); }
fn visit(index: u32, fields: Fields, line: real) -> real { fields_here = fields; return at(index, in_domain(index), line); }
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
@compute @workgroup_size(256)
fn load_residual(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
if (!gate_fresh()) { return; }
start_sums();
for (var index = group.x * 256u + index_in_group; index < 64u; index = index + 256u) {
visit(index, fields_at(index), 0.0);
}
hand_in(group.x, index_in_group);
}
