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
@group(1) @binding(0) var<storage, read> field_heights_pressure: array<real>;
fn read_heights_pressure(index: u32) -> real { return fields_here.heights_pressure; }
@group(1) @binding(1) var<storage, read> field_pressure: array<real>;
fn read_pressure(index: u32) -> real { return fields_here.pressure; }
@group(1) @binding(2) var<storage, read_write> field_residual: array<real>;
fn read_residual(index: u32) -> real { return fields_here.residual; }
fn write_residual(index: u32, value: real) { field_residual[index] = value; }
struct Fields { heights_pressure: real, pressure: real, residual: real,  }
var<private> fields_here: Fields;
fn fields_at(index: u32) -> Fields { return Fields(field_heights_pressure[index], field_pressure[index], field_residual[index], ); }
fn visit(index: u32, fields: Fields, line: real) -> real { fields_here = fields; return at(index, in_domain(index), line); }
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
visit(index, fields_at(index), 0.0);
}
}
