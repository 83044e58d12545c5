// Retains the rows of r + a D M r: what an attraction that falls with the gap takes off the stiffness.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let gap = read_gap(index);
    let residual = read_projected_residual(index);
    // Where the solid yields, it does not feel the law's slope.
    if (in_domain && residual != 0.0 && open(gap) >= 0.0) {
        return residual - real(params.softening) * slope(gap) * finest_answer(index);
    }
    return residual;
}
