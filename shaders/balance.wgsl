// The sums that give the mean pressure under a prescribed mean gap.
fn at(index: u32, in_domain: bool, line: real) -> real {
    balance_terms(read_gap(index), read_pressure(index), in_domain);
    return line;
}
