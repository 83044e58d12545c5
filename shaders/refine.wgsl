// Puts z of a level in the place of the restricted residual: the level's own compliance of it, and z of the next
// coarser level interpolated.
fn at(index: u32, in_domain: bool, line: real) -> real {
    write_restricted(index, real(params.level_compliance) * read_restricted(index) + interpolated(index));
    return line;
}
