// Turns the direction by the retained rows of z and sums what restores the mean gap.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let gap = read_gap(index);
    let elastic = read_pressure(index) + real(scalars.mean_pressure);
    let here = here_at(gap, elastic, in_domain);
    let d = new_direction(line, read_direction(index), here.free);
    write_direction(index, d);
    let step = step_at(here, real(scalars.trial_length) * d, 0.0, in_domain).step;
    into_step_sum(wide(step));
    if (STORES_STEP) {
        write_step(index, step);
        let after = here_at(gap + step, elastic, in_domain);
        into_compliance_sum(wide(after.weight));
    } else {
        into_gap_sum(wide(gap));
        into_depth_sum(wide(max(-(gap + step), 0.0)));
    }
    return line;
}
