// y of the outer state; without a law on the pad.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let elastic = read_pressure(index) + real(scalars.mean_pressure);
    var pull = real(0.0);
    if (in_domain) {
        pull = traction(read_gap(index));
    }
    write_residual(index, elastic + pull);
    return line;
}
