// Adds what the finest level answers a point with of the residual at its four neighbours.
fn add_neighbours(index: u32, answer: real) -> real {
    let x = index % WIDTH;
    let y = row_of(index);
    let before = vec2<u32>(select(x - 1u, WIDTH - 1u, x == 0u), select(y - 1u, HEIGHT - 1u, y == 0u));
    let after = vec2<u32>(select(x + 1u, 0u, x + 1u == WIDTH), select(y + 1u, 0u, y + 1u == HEIGHT));
    let beside = around_at(x, before.y) + around_at(x, after.y) + (around_at(before.x, y) + around_at(after.x, y));
    return answer + real(params.neighbour_compliance) * beside;
}

// Retains the rows of z: that of the first coarser level interpolated, and what the finest level answers.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let here = here_at(read_gap(index), read_pressure(index) + real(scalars.mean_pressure), in_domain);
    let residual = projected_residual(here);
    let previous = read_previous_residual(index);
    let carried = add_interpolated(index, add_neighbours(index, real(params.own_compliance) * residual));
    let z = preconditioned(here, carried);
    descent_terms(z, residual, previous);
    if (MEAN_GAP) {
        mean_gap_descent_terms(z, residual, previous, read_direction(index), here.weight, here.free);
    }
    return z;
}
