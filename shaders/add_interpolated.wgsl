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
