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
@group(1) @binding(0) var<storage, read_write> field_restricted: array<real>;
fn read_restricted(index: u32) -> real { return field_restricted[index]; }
fn write_restricted(index: u32, value: real) { field_restricted[index] = value; }
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

// The cell before or after `cell` on a ring, for a place in the first or second half of `cell`.
fn neighbour(cell: u32, place: u32, ratio: u32, cells: u32) -> u32 {
    if (place < ratio / 2u) {
        return select(cell - 1u, cells - 1u, cell == 0u);
    }
    return select(cell + 1u, 0u, cell + 1u == cells);
}
// Restricts the residual of a level: the transpose of the bilinear interpolation, over the number of finer
// points along a cell. `whole_at` reads the finer field.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let ratio = WHOLE_WIDTH / WIDTH;
    let half = ratio / 2u;
    let first_x = index % WIDTH * ratio + WHOLE_WIDTH - half;
    let first_y = row_of(index) * ratio + WHOLE_HEIGHT - half;
    var sum: real = 0.0;
    // This cell's own points, and the nearer halves of the cells around it.
    for (var row = 0u; row < 2u * ratio; row = row + 1u) {
        let fine_row = (first_y + row) % WHOLE_HEIGHT;
        let own_row = row >= half && row < half + ratio;
        let far_y = neighbour_share((row + half) % ratio, ratio);
        let weight = select(far_y, 1.0 - far_y, own_row);
        for (var column = 0u; column < 2u * ratio; column = column + 1u) {
            let value = whole_at((first_x + column) % WHOLE_WIDTH, fine_row);
            let own_column = column >= half && column < half + ratio;
            let far_x = neighbour_share((column + half) % ratio, ratio);
            sum = sum + weight * select(far_x, 1.0 - far_x, own_column) * value;
        }
    }
    write_restricted(index, sum / real(ratio));
    return line;
}
@compute @workgroup_size(256)
fn coarsen(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) index_in_group: u32) {
if (!gate_fresh()) { return; }
for (var index = group.x * 256u + index_in_group; index < 64u; index = index + 256u) {
at(index, arrive(index), 0.0);
}
}
