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
@group(1) @binding(0) var<storage, read_write> field_share: array<real>;
fn write_share(index: u32, value: real) { field_share[index] = value; }
struct Fields { none: u32, }
var<private> fields_here: Fields;
fn fields_at(index: u32) -> Fields { return Fields(0u); }
fn visit(index: u32, fields: Fields, line: real) -> real { fields_here = fields; return at(index, in_domain(index), line); }
const WIDTH: u32 = 8u;
const HEIGHT: u32 = 8u;
@group(1) @binding(1) var<storage, read> whole_0: array<real>;
const WHOLE_WIDTH: u32 = 4u;
const WHOLE_HEIGHT: u32 = 4u;
fn whole_at(column: u32, row: u32) -> real {
return whole_0[row * 4u + column];
}
// The share of free points in a cell: those where the projected residual, which `whole_at` reads, is not zero.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let ratio = WHOLE_WIDTH / WIDTH;
    let first_x = index % WIDTH * ratio;
    let first_y = row_of(index) * ratio;
    var free: real = 0.0;
    for (var row = 0u; row < ratio; row = row + 1u) {
        for (var column = 0u; column < ratio; column = column + 1u) {
            if (whole_at(first_x + column, first_y + row) != 0.0) {
                free = free + 1.0;
            }
        }
    }
    write_share(index, free / real(ratio * ratio));
    return line;
}
@compute @workgroup_size(256)
fn free_share(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
if (!gate_fresh()) { return; }
for (var index = group.x * 256u + index_in_group; index < 64u; index = index + 256u) {
visit(index, fields_at(index), 0.0);
}
}
