// Adds a field of the coarse level, which `whole_at` reads, interpolated, to a line.
fn add_interpolated(index: u32, line: real) -> real {
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
    return line + ((1.0 - far_y) * here + far_y * there);
}

// z on free points, which are those where the projected residual is not zero, with the long waves added from
// the coarse level.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let residual = read_projected_residual(index);
    let previous = read_previous_residual(index);
    let free = residual != 0.0;
    let z = select(real(0.0), add_interpolated(index, line), free);
    descent_terms(z, residual, previous);
    if (MEAN_GAP) {
        mean_gap_descent_terms(z, residual, previous, read_direction(index), real(1.0), free);
    }
    return z;
}
