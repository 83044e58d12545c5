// Stores rows that were kept.
fn at(index: u32, in_domain: bool, line: real) -> real {
    write_field(index, line);
    return line;
}
