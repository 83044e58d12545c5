// Fills the rows of a transform with g + h less the offset.
fn at(index: u32, in_domain: bool, line: real) -> real {
    return (read_gap(index) - real(scalars.offset)) + read_heights(index);
}
