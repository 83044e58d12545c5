// Fills the rows of a transform with the projected residual and takes the stopping measure on the way.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let here = here_at(read_gap(index), read_pressure(index) + real(scalars.mean_pressure), in_domain);
    residual_terms(here, in_domain);
    let residual = projected_residual(here);
    write_projected_residual(index, residual);
    return residual;
}
