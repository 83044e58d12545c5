alias real = f32;
// declarations.wgsl
// common.wgsl
@group(0) @binding(1) var<storage, read> scalars: Scalars;
// gate.wgsl
// sums.wgsl
// reduce.wgsl
var<private> sum_curvature: part;
fn into_curvature(term: wide) { sum_curvature = add(sum_curvature, term); }
fn start_sums() {
sum_curvature = part_of(wide(0.0));
}
var<workgroup> group_values: array<part, 16>;
fn hand_in(group: u32, thread: u32) {
group_values[0u + thread] = sum_curvature;
workgroupBarrier();
if (thread < 8u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[8u + thread]);
}
workgroupBarrier();
if (thread < 4u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[4u + thread]);
}
workgroupBarrier();
if (thread < 2u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[2u + thread]);
}
workgroupBarrier();
if (thread < 1u) {
group_values[0u + thread] = join_add(group_values[0u + thread], group_values[1u + thread]);
}
workgroupBarrier();
if (thread == 0u) {
partials.values[20u + group] = group_values[0u];
}
}
var<workgroup> exchange: array<vec2<real>, 64>;
const LINES: u32 = 8u;
// Turns a value by a root of unity, and back by its conjugate.
fn turn(value: vec2<real>, root: vec2<real>) -> vec2<real> {
    return vec2<real>(value.x * root.x - value.y * root.y, value.x * root.y + value.y * root.x);
}

fn turn_back(value: vec2<real>, root: vec2<real>) -> vec2<real> {
    return vec2<real>(value.x * root.x + value.y * root.y, value.y * root.x - value.x * root.y);
}
// The stiffness of a half-space at a wavevector: the length of (column, row) in steps of the stiffness of
// the longest waves. `factors` holds the zero wavevector's factor and these two steps.
fn wave_stiffness(column: u32, row: u32) -> real {
    let x = factors[1] * real(column);
    let y = factors[2] * real(row);
    return sqrt(x * x + y * y);
}
// The stiffness itself.
fn factor_of(column: u32, row: u32) -> real {
    if (column + row == 0u) {
        return factors[0];
    }
    return wave_stiffness(column, row);
}
@group(1) @binding(1) var<storage, read_write> work: array<vec2<real>>;
@group(1) @binding(0) var<storage, read> roots: array<vec2<real>>;
@group(1) @binding(2) var<storage, read> factors: array<real>;
@compute @workgroup_size(2, 8)
fn multiply(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
if (!gate_running()) { return; }
start_sums();
let thread = place.x;
let line = place.y;
let column = group.x * LINES + line;
let inside = column < 5u;
let own = column == 0u || 2u * column == 8u;
let here = column * 4u;
let mirror_column = select(8u - column, 0u, column == 0u);
let there = mirror_column * 4u;
if (group.x == 0u && index_in_group == 0u) { partials.transforms = partials.transforms + 2u; }
var v0 = vec2<real>(0.0, 0.0);
var v1 = vec2<real>(0.0, 0.0);
var v2 = vec2<real>(0.0, 0.0);
var v3 = vec2<real>(0.0, 0.0);
if (inside) {
{ let j = thread + 0u;
{ let z = work[here + (j + 0u)];
let mirror = work[there + (j + 0u)];
v0 = 0.5 * vec2<real>(z.x + mirror.x, z.y - mirror.y);
v2 = 0.5 * vec2<real>(z.y + mirror.y, mirror.x - z.x); }
{ let z = work[here + (j + 2u)];
let mirror = work[there + (j + 2u)];
v1 = 0.5 * vec2<real>(z.x + mirror.x, z.y - mirror.y);
v3 = 0.5 * vec2<real>(z.y + mirror.y, mirror.x - z.x); }
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
exchange[line * 8u + (start + 0u)] = v0;
exchange[line * 8u + (start + 1u)] = v1;
exchange[line * 8u + (start + 2u)] = v2;
exchange[line * 8u + (start + 3u)] = v3;
}
workgroupBarrier();
{ let j = thread + 0u;
v0 = exchange[line * 8u + ((j + 0u))];
v1 = exchange[line * 8u + ((j + 4u))];
}
{ let j = thread + 2u;
v2 = exchange[line * 8u + ((j + 0u))];
v3 = exchange[line * 8u + ((j + 4u))];
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
let weight = select(real(2.0), real(1.0), own);
{ let j = thread + 0u;
{ let row = (j + 0u);
let factor = factor_of(column, min(row, 8u - row));
into_curvature(wide(weight * factor * dot(v0, v0)));
v0 = (1.5625e-2 * factor) * v0; }
{ let row = (j + 4u);
let factor = factor_of(column, min(row, 8u - row));
into_curvature(wide(weight * factor * dot(v1, v1)));
v1 = (1.5625e-2 * factor) * v1; }
}
{ let j = thread + 2u;
{ let row = (j + 0u);
let factor = factor_of(column, min(row, 8u - row));
into_curvature(wide(weight * factor * dot(v2, v2)));
v2 = (1.5625e-2 * factor) * v2; }
{ let row = (j + 4u);
let factor = factor_of(column, min(row, 8u - row));
into_curvature(wide(weight * factor * dot(v3, v3)));
v3 = (1.5625e-2 * factor) * v3; }
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
workgroupBarrier();
{ let j = thread + 0u;
let start = (j / 1u) * 2u + j % 1u;
exchange[line * 8u + (start + 0u)] = v0;
exchange[line * 8u + (start + 1u)] = v1;
}
{ let j = thread + 2u;
let start = (j / 1u) * 2u + j % 1u;
exchange[line * 8u + (start + 0u)] = v2;
exchange[line * 8u + (start + 1u)] = v3;
}
workgroupBarrier();
{ let j = thread + 0u;
v0 = exchange[line * 8u + ((j + 0u))];
v1 = exchange[line * 8u + ((j + 2u))];
v2 = exchange[line * 8u + ((j + 4u))];
v3 = exchange[line * 8u + ((j + 6u))];
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
work[here + (j + 0u)] = vec2<real>(v0.x - v2.y, v0.y + v2.x);
if (!own) { work[there + (j + 0u)] = vec2<real>(v0.x + v2.y, v2.x - v0.y); }
work[here + (j + 2u)] = vec2<real>(v1.x - v3.y, v1.y + v3.x);
if (!own) { work[there + (j + 2u)] = vec2<real>(v1.x + v3.y, v3.x - v1.y); }
}
}
hand_in(group.x, index_in_group);
}
