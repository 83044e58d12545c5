// The stopping measure of the present state.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let here = here_at(read_gap(index), read_pressure(index) + real(scalars.mean_pressure), in_domain);
    residual_terms(here, in_domain);
    return line;
}
