alias real = f32;
// declarations.wgsl
// common.wgsl
@group(0) @binding(1) var<storage, read> scalars: Scalars;
// gate.wgsl
// sums.wgsl
// reduce.wgsl
var<private> sum_gap_excess: part;
fn into_gap_excess(term: wide) { sum_gap_excess = add(sum_gap_excess, term); }
var<private> sum_restoring_weight: part;
fn into_restoring_weight(term: wide) { sum_restoring_weight = add(sum_restoring_weight, term); }
fn start_sums() {
sum_gap_excess = part_of(wide(0.0));
sum_restoring_weight = part_of(wide(0.0));
}
var<workgroup> group_values: array<part, 512>;
fn hand_in(group: u32, thread: u32) {
group_values[0u + thread] = sum_gap_excess;
group_values[256u + thread] = sum_restoring_weight;
workgroupBarrier();
if (thread < 128u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[128u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[384u + thread]);
}
workgroupBarrier();
if (thread < 64u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[64u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[320u + thread]);
}
workgroupBarrier();
if (thread < 32u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[32u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[288u + thread]);
}
workgroupBarrier();
if (thread < 16u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[16u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[272u + thread]);
}
workgroupBarrier();
if (thread < 8u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[8u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[264u + thread]);
}
workgroupBarrier();
if (thread < 4u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[4u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[260u + thread]);
}
workgroupBarrier();
if (thread < 2u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[2u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[258u + thread]);
}
workgroupBarrier();
if (thread < 1u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[1u + thread]);
group_values[256u + thread] = join_add(group_values[256u + thread], group_values[257u + thread]);
}
workgroupBarrier();
if (thread == 0u) {
partials.values[0u + group] = group_values[0u];
partials.values[1u + group] = group_values[256u];
}
}
fn row_of(index: u32) -> u32 {
return index / 8u;
}
fn in_domain(index: u32) -> bool { return true; }
@group(1) @binding(0) var<storage, read> field_correction: array<real>;
fn read_correction(index: u32) -> real { return fields_here.correction; }
@group(1) @binding(1) var<storage, read_write> field_gap: array<real>;
fn read_gap(index: u32) -> real { return fields_here.gap; }
fn write_gap(index: u32, value: real) { field_gap[index] = value; }
const law_factor: real = 1.0;
struct Fields { correction: real, gap: real,  }
var<private> fields_here: Fields;
fn fields_at(index: u32) -> Fields { return Fields(field_correction[index], field_gap[index], ); }
fn visit(index: u32, fields: Fields, line: real) -> real { fields_here = fields; return at(index, in_domain(index), line); }
const WIDTH: u32 = 8u;
const HEIGHT: u32 = 8u;
// No attraction at all.
fn law_traction(gap_here: real) -> real {
    return 0.0;
}

fn law_energy(gap_here: real) -> real {
    return 0.0;
}

fn law_slope(gap_here: real) -> real {
    return 0.0;
}

// The gain of the traction over a step, to the rounding of the gain itself.
fn law_difference(gap_here: real, step: real) -> real {
    return 0.0;
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
// Adds a correction found in single precision to the gap of the outer state.
fn at(index: u32, in_domain: bool, line: real) -> real {
    var gap = read_gap(index) + read_correction(index);
    if (in_domain) {
        gap = corrected_gap(read_gap(index), read_correction(index));
    }
    write_gap(index, gap);
    into_gap_excess(wide(gap) - scalars.offset);
    into_restoring_weight(wide(pressure_weight(here_at(gap, 0.0, in_domain))));
    return line;
}
@compute @workgroup_size(256)
fn add_correction(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
if (!gate_always()) { return; }
start_sums();
for (var index = group.x * 256u + index_in_group; index < 64u; index = index + 256u) {
visit(index, fields_at(index), 0.0);
}
hand_in(group.x, index_in_group);
}
