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
