// Stores the rows of a transform times the weight: the long-wave part of z.
fn at(index: u32, in_domain: bool, line: real) -> real {
    write_long_waves(index, read_weight(index) * line);
    return line;
}
