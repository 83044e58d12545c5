// Puts z of a level in the place of the restricted residual: the level's own compliance of it, and z of the next
// coarser level interpolated.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let own = real(params.level_compliance) * read_restricted(index);
    write_restricted(index, add_interpolated(index, own));
    return line;
}
