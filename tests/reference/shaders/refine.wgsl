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
fn read_restricted(index: u32) -> real { return fields_here.restricted; }
fn write_restricted(index: u32, value: real) { field_restricted[index] = value; }
struct Fields { restricted: real,  }
var<private> fields_here: Fields;
fn fields_at(index: u32) -> Fields { return Fields(field_restricted[index], ); }
fn visit(index: u32, fields: Fields, line: real) -> real { fields_here = fields; return at(index, in_domain(index), line); }
const WIDTH: u32 = 8u;
const HEIGHT: u32 = 8u;
@group(1) @binding(1) var<storage, read> whole_0: array<real>;
const WHOLE_WIDTH: u32 = 4u;
const WHOLE_HEIGHT: u32 = 4u;
fn whole_at(column: u32, row: u32) -> real {
return whole_0[row * 4u + column];
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
// Puts z of a level in the place of the restricted residual: the level's own compliance of it, and z of the next
// coarser level interpolated.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let own = real(params.level_compliance) * read_restricted(index);
    write_restricted(index, add_interpolated(index, own));
    return line;
}
@compute @workgroup_size(256)
fn refine(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
if (!gate_fresh()) { return; }
for (var index = group.x * 256u + index_in_group; index < 64u; index = index + 256u) {
visit(index, fields_at(index), 0.0);
}
}
