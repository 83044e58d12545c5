// Fills the rows of a transform with the restricted residual times the weight that is there already.
fn at(index: u32, in_domain: bool, line: real) -> real {
    return read_restricted(index) * read_weight(index);
}
