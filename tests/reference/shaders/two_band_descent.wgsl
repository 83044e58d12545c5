alias real = f32;
// declarations.wgsl
// common.wgsl
@group(0) @binding(1) var<storage, read> scalars: Scalars;
const SUM_COUNT: u32 = 3u;
var<private> sums: array<wide, SUM_COUNT>;
// gate.wgsl
// sums.wgsl
const GROUP_THREADS: u32 = 4u;
const GROUP_HALF: u32 = 2u;
const SUMS_AT_ONCE: u32 = 2u;
const GROUP_VALUES: u32 = 8u;
// reduce.wgsl
fn join_slot(slot: u32, a: part, b: part) -> part {
switch slot {
default: { return join_add(a, b); }
}
}
fn start_sums() {
sums[0] = wide(0.0);
sums[1] = wide(0.0);
}
fn hand_in(group: u32, thread: u32) {
for (var first = 0u; first < 2u; first = first + SUMS_AT_ONCE) {
gather(first, thread);
if (thread < SUMS_AT_ONCE && first + thread < 2u) {
partials.values[10u + (first + thread) * 1u + group] = group_values[thread * GROUP_THREADS];
}
}
}
fn row_of(index: u32) -> u32 {
return index / 8u;
}
fn in_domain(index: u32) -> bool { return true; }
fn arrive(index: u32) -> bool { return in_domain(index); }
@group(1) @binding(0) var<storage, read> field_projected_residual: array<real>;
fn read_projected_residual(index: u32) -> real { return field_projected_residual[index]; }
@group(1) @binding(1) var<storage, read> field_previous_residual: array<real>;
fn read_previous_residual(index: u32) -> real { return field_previous_residual[index]; }
fn read_direction(index: u32) -> real { return 0.0; }
fn write_direction(index: u32, value: real) {}
const WIDTH: u32 = 8u;
const HEIGHT: u32 = 8u;
@group(1) @binding(2) var<storage, read> whole_0: array<real>;
const WHOLE_WIDTH: u32 = 4u;
const WHOLE_HEIGHT: u32 = 4u;
fn whole_at(column: u32, row: u32) -> real {
return whole_0[row * WHOLE_WIDTH + column];
}
const MEAN_GAP: bool = false;
const Z_RESIDUAL: u32 = 0u;
const Z_CHANGE: u32 = 1u;
const DIRECTION_CHANGE: u32 = 2u;
const DIRECTION_RESIDUAL: u32 = 2u;
const WEIGHTED_Z: u32 = 2u;
const FREE_WEIGHT: u32 = 2u;
const FREE_RESIDUAL: u32 = 2u;
const FREE_CHANGE: u32 = 2u;
const WEIGHTED_DIRECTION: u32 = 2u;
// Interpolation between the fine level and the coarse one. Twins: kernel/two_band.rs.

// Share of the neighbouring cell in the value at a place of a cell of `ratio` points.
fn neighbour_share(place: u32, ratio: u32) -> real {
    return abs(real(2u * place + 1u) / real(2u * ratio) - 0.5);
}

// The cell before or after `cell` on a ring, for a place in the first or second half of `cell`.
fn neighbour(cell: u32, place: u32, ratio: u32, cells: u32) -> u32 {
    if (place < ratio / 2u) {
        return select(cell - 1u, cells - 1u, cell == 0u);
    }
    return select(cell + 1u, 0u, cell + 1u == cells);
}
// What beta is made of. Twins: kernel/descent.rs.
fn descent_terms(z: real, residual: real, previous: real) {
    add_sum(Z_RESIDUAL, wide(z) * wide(residual));
    add_sum(Z_CHANGE, wide(z) * (wide(residual) - wide(previous)));
}

// What the direction adds to it, and what takes the means off, in the measure `weight` of the free points.
fn mean_gap_descent_terms(z: real, residual: real, previous: real, direction: real, weight: real, free: bool) {
    let d = wide(direction);
    let r = wide(residual);
    let w = wide(weight);
    let change_here = r - wide(previous);
    add_sum(DIRECTION_CHANGE, d * change_here);
    if (free) {
        add_sum(DIRECTION_RESIDUAL, d * r);
        add_sum(WEIGHTED_Z, w * wide(z));
        add_sum(FREE_WEIGHT, w);
        add_sum(FREE_RESIDUAL, r);
        add_sum(FREE_CHANGE, change_here);
        add_sum(WEIGHTED_DIRECTION, w * d);
    }
}
// Adds a field of the coarse level, which `whole_at` reads, interpolated, to a line.
fn add_interpolated(index: u32, line: real) -> real {
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
    return line + ((1.0 - far_y) * here + far_y * there);
}

// z on free points, which are those where the projected residual is not zero, with the long waves added from
// the coarse level.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let residual = read_projected_residual(index);
    let previous = read_previous_residual(index);
    let free = residual != 0.0;
    let z = select(real(0.0), add_interpolated(index, line), free);
    descent_terms(z, residual, previous);
    if (MEAN_GAP) {
        mean_gap_descent_terms(z, residual, previous, read_direction(index), real(1.0), free);
    }
    return z;
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
@compute @workgroup_size(4, 1)
fn two_band_descent(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
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
var v4 = vec2<real>(0.0, 0.0);
var v5 = vec2<real>(0.0, 0.0);
var v6 = vec2<real>(0.0, 0.0);
var v7 = vec2<real>(0.0, 0.0);
if (inside) {
{ let j = thread + 0u;
v0 = work[(j + 0u) * 4u + pair];
v1 = work[(j + 1u) * 4u + pair];
v2 = work[(j + 2u) * 4u + pair];
v3 = work[(j + 3u) * 4u + pair];
v4 = work[(j + 4u) * 4u + pair];
v5 = work[(j + 5u) * 4u + pair];
v6 = work[(j + 6u) * 4u + pair];
v7 = work[(j + 7u) * 4u + pair];
}
}
{ let j = thread + 0u;
{
{
let even_sum = v0 + v4;
let even_difference = v0 - v4;
let odd_sum = v2 + v6;
let odd_difference = v2 - v6;
let turned = vec2<real>(-odd_difference.y, odd_difference.x);
v0 = even_sum + odd_sum;
v2 = even_difference + turned;
v4 = even_sum - odd_sum;
v6 = even_difference - turned;
}
{
let even_sum = v1 + v5;
let even_difference = v1 - v5;
let odd_sum = v3 + v7;
let odd_difference = v3 - v7;
let turned = vec2<real>(-odd_difference.y, odd_difference.x);
v1 = even_sum + odd_sum;
v3 = even_difference + turned;
v5 = even_sum - odd_sum;
v7 = even_difference - turned;
}
let first = 7.071067811865476e-1 * vec2<real>(v3.x - v3.y, v3.y + v3.x);
let second = vec2<real>(-v5.y, v5.x);
let third = 7.071067811865476e-1 * vec2<real>(-v7.x - v7.y, -v7.y + v7.x);
let low_0 = v0 + v1;
let high_0 = v0 - v1;
let low_1 = v2 + first;
let high_1 = v2 - first;
let low_2 = v4 + second;
let high_2 = v4 - second;
let low_3 = v6 + third;
let high_3 = v6 - third;
v0 = low_0;
v4 = high_0;
v1 = low_1;
v5 = high_1;
v2 = low_2;
v6 = high_2;
v3 = low_3;
v7 = high_3;
}
}
if (inside) {
{ let j = thread + 0u;
{ let index = pair * 8u + (j + 0u);
let upper = at(index + 0u, arrive(index + 0u), v0.x);
v0 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), v0.y)); }
{ let index = pair * 8u + (j + 1u);
let upper = at(index + 0u, arrive(index + 0u), v1.x);
v1 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), v1.y)); }
{ let index = pair * 8u + (j + 2u);
let upper = at(index + 0u, arrive(index + 0u), v2.x);
v2 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), v2.y)); }
{ let index = pair * 8u + (j + 3u);
let upper = at(index + 0u, arrive(index + 0u), v3.x);
v3 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), v3.y)); }
{ let index = pair * 8u + (j + 4u);
let upper = at(index + 0u, arrive(index + 0u), v4.x);
v4 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), v4.y)); }
{ let index = pair * 8u + (j + 5u);
let upper = at(index + 0u, arrive(index + 0u), v5.x);
v5 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), v5.y)); }
{ let index = pair * 8u + (j + 6u);
let upper = at(index + 0u, arrive(index + 0u), v6.x);
v6 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), v6.y)); }
{ let index = pair * 8u + (j + 7u);
let upper = at(index + 0u, arrive(index + 0u), v7.x);
v7 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), v7.y)); }
}
}
if (inside) {
{ let j = thread + 0u;
work[(j + 0u) * 4u + pair] = v0;
work[(j + 1u) * 4u + pair] = v1;
work[(j + 2u) * 4u + pair] = v2;
work[(j + 3u) * 4u + pair] = v3;
work[(j + 4u) * 4u + pair] = v4;
work[(j + 5u) * 4u + pair] = v5;
work[(j + 6u) * 4u + pair] = v6;
work[(j + 7u) * 4u + pair] = v7;
}
}
hand_in(group.x, index_in_group);
}
