// Retains the rows of z: that of the first coarser level interpolated, and the finest level's own compliance.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let here = here_at(read_gap(index), read_pressure(index) + real(scalars.mean_pressure), in_domain);
    let residual = projected_residual(here);
    let previous = read_previous_residual(index);
    let carried = add_interpolated(index, real(params.level_compliance) * residual);
    let z = preconditioned(here, carried);
    descent_terms(z, residual, previous);
    if (MEAN_GAP) {
        mean_gap_descent_terms(z, residual, previous, read_direction(index), here.weight, here.free);
    }
    return z;
}
