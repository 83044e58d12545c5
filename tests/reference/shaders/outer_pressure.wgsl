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
@group(1) @binding(0) var<storage, read> field_heights_pressure: array<real>;
fn read_heights_pressure(index: u32) -> real { return field_heights_pressure[index]; }
@group(1) @binding(1) var<storage, read> field_pressure: array<real>;
fn read_pressure(index: u32) -> real { return field_pressure[index]; }
@group(1) @binding(2) var<storage, read_write> field_residual: array<real>;
fn read_residual(index: u32) -> real { return field_residual[index]; }
fn write_residual(index: u32, value: real) { field_residual[index] = value; }
const WIDTH: u32 = 8u;
const HEIGHT: u32 = 8u;
// The outer residual less the pressure that the outer gap makes.
fn at(index: u32, in_domain: bool, line: real) -> real {
    write_residual(index, read_residual(index) + (read_heights_pressure(index) - read_pressure(index)));
    return line;
}
@compute @workgroup_size(256)
fn outer_pressure(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
if (!gate_always()) { return; }
for (var index = group.x * 256u + index_in_group; index < 64u; index = index + 256u) {
at(index, arrive(index), 0.0);
}
}
