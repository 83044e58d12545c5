// Takes the smoothed share of free points, stores its cube, clipped to [0, 1], as the weight, and
// fills the rows of a transform with the restricted residual times it.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let m = clamp(line, 0.0, 1.0);
    let weight = m * m * m;
    write_weight(index, weight);
    return read_restricted(index) * weight;
}
