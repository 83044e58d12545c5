alias real = f32;
// declarations.wgsl
// common.wgsl
@group(0) @binding(1) var<storage, read> scalars: Scalars;
// gate.wgsl
// sums.wgsl
// reduce.wgsl
fn row_of(index: u32) -> u32 {
return index / 8u;
}
fn in_domain(index: u32) -> bool { return true; }
@group(1) @binding(0) var<storage, read> field_gap: array<real>;
fn read_gap(index: u32) -> real { return fields_here.gap; }
@group(1) @binding(1) var<storage, read> field_projected_residual: array<real>;
fn read_projected_residual(index: u32) -> real { return fields_here.projected_residual; }
const law_factor: real = 1.0;
struct Fields { gap: real, projected_residual: real,  }
var<private> fields_here: Fields;
fn fields_at(index: u32) -> Fields { return Fields(field_gap[index], field_projected_residual[index], ); }
fn visit(index: u32, fields: Fields, line: real) -> real { fields_here = fields; return at(index, in_domain(index), line); }
const WIDTH: u32 = 8u;
const HEIGHT: u32 = 8u;
@group(1) @binding(2) var<storage, read> around_0: array<real>;
const AROUND_WIDTH: u32 = 8u;
const AROUND_HEIGHT: u32 = 8u;
fn around_at(column: u32, row: u32) -> real {
return around_0[row * 8u + column];
}
@group(1) @binding(3) var<storage, read> whole_0: array<real>;
const WHOLE_WIDTH: u32 = 4u;
const WHOLE_HEIGHT: u32 = 4u;
fn whole_at(column: u32, row: u32) -> real {
return whole_0[row * 4u + column];
}
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
// Interpolation between a level and the next coarser one. Twins: kernel/multilevel.rs.

// Share of the neighbouring cell in the value at a place of a cell of `ratio` points.
fn neighbour_share(place: u32, ratio: u32) -> real {
    return abs(real(2u * place + 1u) / real(2u * ratio) - 0.5);
}

// The place before one on a ring.
fn before(place: u32, places: u32) -> u32 {
    return select(place - 1u, places - 1u, place == 0u);
}

// The place after one on a ring.
fn after(place: u32, places: u32) -> u32 {
    return select(place + 1u, 0u, place + 1u == places);
}

// The cell before or after `cell` on a ring, for a place in the first or second half of `cell`.
fn neighbour(cell: u32, place: u32, ratio: u32, cells: u32) -> u32 {
    if (place < ratio / 2u) {
        return before(cell, cells);
    }
    return after(cell, cells);
}
// Adds a field of the next coarser level, which `whole_at` reads, interpolated. Twins: kernel/multilevel.rs.
fn add_interpolated(index: u32, value: real) -> real {
    let ratio = WIDTH / WHOLE_WIDTH;
    let x = index % WIDTH;
    let y = row_of(index);
    let column = x / ratio;
    let row = y / ratio;
    let beside = neighbour(column, x % ratio, ratio, WHOLE_WIDTH);
    let other = neighbour(row, y % ratio, ratio, WHOLE_HEIGHT);
    let far_x = neighbour_share(x % ratio, ratio);
    let far_y = neighbour_share(y % ratio, ratio);
    let here = (1.0 - far_x) * whole_at(column, row) + far_x * whole_at(beside, row);
    let there = (1.0 - far_x) * whole_at(column, other) + far_x * whole_at(beside, other);
    return value + ((1.0 - far_y) * here + far_y * there);
}
// What the levels answer a point with: z of the first coarser one interpolated, and the finest level's answer to the
// residual there and at its four neighbours. Twins: kernel/multilevel.rs.
fn finest_answer(index: u32) -> real {
    let x = index % WIDTH;
    let y = row_of(index);
    let before = vec2<u32>(select(x - 1u, WIDTH - 1u, x == 0u), select(y - 1u, HEIGHT - 1u, y == 0u));
    let after = vec2<u32>(select(x + 1u, 0u, x + 1u == WIDTH), select(y + 1u, 0u, y + 1u == HEIGHT));
    let own = real(params.own_compliance) * around_at(x, y);
    let beside = around_at(x, before.y) + around_at(x, after.y) + (around_at(before.x, y) + around_at(after.x, y));
    return add_interpolated(index, own + real(params.neighbour_compliance) * beside);
}
// Retains the rows of r + a D M r: what an attraction that falls with the gap takes off the stiffness.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let gap = read_gap(index);
    let residual = read_projected_residual(index);
    // Where the solid yields, it does not feel the law's slope.
    if (in_domain && residual != 0.0 && open(gap) >= 0.0) {
        return residual - real(params.softening) * slope(gap) * finest_answer(index);
    }
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
fn soften(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
if (!gate_fresh()) { return; }
let line = place.x;
let thread = place.y;
if (group.x == 0u && index_in_group == 0u) { partials.transforms = partials.transforms + 0u; }
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
if (inside) {
{ let j = thread + 0u;
work[(j + 0u) * 4u + pair] = v0;
work[(j + 2u) * 4u + pair] = v1;
work[(j + 4u) * 4u + pair] = v2;
work[(j + 6u) * 4u + pair] = v3;
}
}
}
