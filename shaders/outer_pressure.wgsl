// Minus the pressure that the outer gap makes.
fn at(index: u32, in_domain: bool, line: real) -> real {
    write_difference(index, read_heights_pressure(index) - read_pressure(index));
    return line;
}
