// Stores the rows of a transform times the weight: z of the coarsest level.
fn at(index: u32, in_domain: bool, line: real) -> real {
    write_coarsest_z(index, read_weight(index) * line);
    return line;
}
