// Fills the rows of a transform with a field as it is.
fn at(index: u32, in_domain: bool, line: real) -> real {
    return read_field(index);
}
