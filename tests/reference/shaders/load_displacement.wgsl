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
fn arrive(index: u32) -> bool { return in_domain(index); }
@group(1) @binding(0) var<storage, read> field_gap: array<real>;
fn read_gap(index: u32) -> real { return field_gap[index]; }
@group(1) @binding(1) var<storage, read> field_heights: array<real>;
fn read_heights(index: u32) -> real { return field_heights[index]; }
const WIDTH: u32 = 8u;
const HEIGHT: u32 = 8u;
// Fills the rows of a transform with g + h less the offset.
fn at(index: u32, in_domain: bool, line: real) -> real {
    return (read_gap(index) - real(scalars.offset)) + read_heights(index);
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
fn load_displacement(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
if (!gate_always()) { return; }
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
{ let index = pair * 8u + (j + 0u);
let upper = at(index + 0u, arrive(index + 0u), 0.0);
v0 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), 0.0)); }
{ let index = pair * 8u + (j + 2u);
let upper = at(index + 0u, arrive(index + 0u), 0.0);
v1 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), 0.0)); }
{ let index = pair * 8u + (j + 4u);
let upper = at(index + 0u, arrive(index + 0u), 0.0);
v2 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), 0.0)); }
{ let index = pair * 8u + (j + 6u);
let upper = at(index + 0u, arrive(index + 0u), 0.0);
v3 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), 0.0)); }
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
}
