alias real = f32;
// declarations.wgsl
// common.wgsl
@group(0) @binding(1) var<storage, read> scalars: Scalars;
const SUM_COUNT: u32 = 1u;
var<private> sums: array<wide, SUM_COUNT>;
// gate.wgsl
// sums.wgsl
fn row_of(index: u32) -> u32 {
return index / 8u;
}
fn in_domain(index: u32) -> bool { return true; }
fn arrive(index: u32) -> bool { return in_domain(index); }
@group(1) @binding(0) var<storage, read> field_restricted: array<real>;
fn read_restricted(index: u32) -> real { return field_restricted[index]; }
@group(1) @binding(1) var<storage, read> field_weight: array<real>;
fn read_weight(index: u32) -> real { return field_weight[index]; }
const WIDTH: u32 = 8u;
const HEIGHT: u32 = 8u;
// Fills the rows of a transform with the restricted residual times the weight that is there already.
fn at(index: u32, in_domain: bool, line: real) -> real {
    return read_restricted(index) * read_weight(index);
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
fn load_weighted(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) place: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
if (!gate_fresh()) { return; }
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
{ let index = pair * 8u + (j + 0u);
let upper = at(index + 0u, arrive(index + 0u), 0.0);
v0 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), 0.0)); }
{ let index = pair * 8u + (j + 1u);
let upper = at(index + 0u, arrive(index + 0u), 0.0);
v1 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), 0.0)); }
{ let index = pair * 8u + (j + 2u);
let upper = at(index + 0u, arrive(index + 0u), 0.0);
v2 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), 0.0)); }
{ let index = pair * 8u + (j + 3u);
let upper = at(index + 0u, arrive(index + 0u), 0.0);
v3 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), 0.0)); }
{ let index = pair * 8u + (j + 4u);
let upper = at(index + 0u, arrive(index + 0u), 0.0);
v4 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), 0.0)); }
{ let index = pair * 8u + (j + 5u);
let upper = at(index + 0u, arrive(index + 0u), 0.0);
v5 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), 0.0)); }
{ let index = pair * 8u + (j + 6u);
let upper = at(index + 0u, arrive(index + 0u), 0.0);
v6 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), 0.0)); }
{ let index = pair * 8u + (j + 7u);
let upper = at(index + 0u, arrive(index + 0u), 0.0);
v7 = vec2<real>(upper, at(index + 32u, arrive(index + 32u), 0.0)); }
}
}
{ let j = thread + 0u;
{
{
let even_sum = v0 + v4;
let even_difference = v0 - v4;
let odd_sum = v2 + v6;
let odd_difference = v2 - v6;
let turned = vec2<real>(odd_difference.y, -odd_difference.x);
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
let turned = vec2<real>(odd_difference.y, -odd_difference.x);
v1 = even_sum + odd_sum;
v3 = even_difference + turned;
v5 = even_sum - odd_sum;
v7 = even_difference - turned;
}
let first = 7.071067811865476e-1 * vec2<real>(v3.x + v3.y, v3.y - v3.x);
let second = vec2<real>(v5.y, -v5.x);
let third = 7.071067811865476e-1 * vec2<real>(-v7.x + v7.y, -v7.y - v7.x);
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
}
