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
@group(1) @binding(0) var<storage, read_write> field_restricted: array<real>;
fn write_restricted(index: u32, value: real) { field_restricted[index] = value; }
struct Fields { none: u32, }
var<private> fields_here: Fields;
fn fields_at(index: u32) -> Fields { return Fields(0u); }
fn visit(index: u32, fields: Fields, line: real) -> real { fields_here = fields; return at(index, in_domain(index), line); }
const WIDTH: u32 = 8u;
const HEIGHT: u32 = 8u;
@group(1) @binding(1) var<storage, read> whole_0: array<real>;
const WHOLE_WIDTH: u32 = 16u;
const WHOLE_HEIGHT: u32 = 16u;
fn whole_at(column: u32, row: u32) -> real {
return whole_0[row * 16u + column];
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
// Restricts the residual of a level: the transpose of the bilinear interpolation, over the number of finer
// points along a cell. `whole_at` reads the finer field. Written out, since no compiler unrolls loops of a checked shader.
const RATIO: u32 = 2u;

fn at(index: u32, in_domain: bool, line: real) -> real {
    let x = RATIO * (index % WIDTH);
    let y = RATIO * row_of(index);
    let left = before(x, WHOLE_WIDTH);
    let right = after(x + 1u, WHOLE_WIDTH);
    let above = before(y, WHOLE_HEIGHT);
    let below = after(y + 1u, WHOLE_HEIGHT);
    // This cell's own rows, and the nearer ones of the cells before and after.
    let a = vec4<real>(whole_at(left, above), whole_at(x, above), whole_at(x + 1u, above), whole_at(right, above));
    let b = vec4<real>(whole_at(left, y), whole_at(x, y), whole_at(x + 1u, y), whole_at(right, y));
    let c = vec4<real>(whole_at(left, y + 1u), whole_at(x, y + 1u), whole_at(x + 1u, y + 1u), whole_at(right, y + 1u));
    let d = vec4<real>(whole_at(left, below), whole_at(x, below), whole_at(x + 1u, below), whole_at(right, below));
    let far = neighbour_share(0u, RATIO);
    let near = 1.0 - far;
    let columns = (far * (a + d) + near * (b + c)) / real(RATIO);
    write_restricted(index, near * (columns.y + columns.z) + far * (columns.x + columns.w));
    return line;
}
@compute @workgroup_size(256)
fn coarsen(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
if (!gate_fresh()) { return; }
for (var index = group.x * 256u + index_in_group; index < 64u; index = index + 256u) {
visit(index, fields_at(index), 0.0);
}
}
