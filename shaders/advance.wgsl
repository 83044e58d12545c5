// Takes K s and steps where the mean gap is prescribed: g += t s, p += t K s.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let pressure = read_pressure(index);
    var answer = line;
    if (LINEAR) {
        // K s from K s0 and K g.
        let bent = pressure - read_heights_pressure(index);
        answer = answer + real(scalars.mean_gap_correction) * (answer + bent);
    }
    let way = select(read_direction(index), read_step(index), STORES_STEP);
    let moved = step_from(read_gap(index), pressure, way, answer, in_domain);
    write_gap(index, moved.gap);
    write_pressure(index, moved.pressure);
    write_previous_residual(index, moved.previous);
    balance_terms(moved.gap, moved.pressure, in_domain);
    return line;
}
