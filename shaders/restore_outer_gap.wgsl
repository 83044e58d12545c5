// Brings the mean gap of the outer state back to the prescribed one.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let gap = read_gap(index);
    let weight = pressure_weight(here_at(gap, 0.0, in_domain));
    write_gap(index, gap - real(scalars.mean_gap_correction) * weight);
    return line;
}
