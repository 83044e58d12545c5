// Retains the rows of z: what the levels answer, on free points.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let answer = finest_answer(index);
    let previous = read_previous_residual(index);
    if (!MEAN_GAP && !STORES_STEP) {
        // At a wall the projected residual says all: a point is free where that is not zero.
        let known = read_projected_residual(index);
        let z_known = select(real(0.0), answer, known != 0.0);
        descent_terms(z_known, known, previous);
        return z_known;
    }
    let here = here_at(read_gap(index), read_pressure(index) + real(scalars.mean_pressure), in_domain);
    let residual = projected_residual(here);
    let z = preconditioned(here, answer);
    descent_terms(z, residual, previous);
    if (MEAN_GAP) {
        mean_gap_descent_terms(z, residual, previous, read_direction(index), here.weight, here.free);
    }
    return z;
}
