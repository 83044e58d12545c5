// Retains the rows of z: what the levels answer, on free points.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let here = here_at(read_gap(index), read_pressure(index) + real(scalars.mean_pressure), in_domain);
    let residual = projected_residual(here);
    let previous = read_previous_residual(index);
    let z = preconditioned(here, finest_answer(index));
    descent_terms(z, residual, previous);
    if (MEAN_GAP) {
        mean_gap_descent_terms(z, residual, previous, read_direction(index), here.weight, here.free);
    }
    return z;
}
