// The outer residual less the pressure that the outer gap makes.
fn at(index: u32, in_domain: bool, line: real) -> real {
    write_residual(index, read_residual(index) + (read_heights_pressure(index) - read_pressure(index)));
    return line;
}
