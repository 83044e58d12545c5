// Adds a correction found in single precision to the gap of the outer state.
fn at(index: u32, in_domain: bool, line: real) -> real {
    var gap = read_gap(index) + read_correction(index);
    if (in_domain) {
        gap = corrected_gap(read_gap(index), read_correction(index));
    }
    write_gap(index, gap);
    into_gap_excess(wide(gap) - scalars.offset);
    into_restoring_weight(wide(pressure_weight(here_at(gap, 0.0, in_domain))));
    return line;
}
