// Turns the direction by the retained rows of z and fills the rows of a transform with the trial step.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let pressure = read_pressure(index);
    let here = here_at(read_gap(index), pressure + real(scalars.mean_pressure), in_domain);
    let d = new_direction(line, read_direction(index), here.free);
    write_direction(index, d);
    let tried = step_at(here, real(scalars.trial_length) * d, 0.0, in_domain);
    if (LINEAR) {
        linear_trial_terms(tried, here, pressure - read_heights_pressure(index));
    } else {
        trial_terms(tried, here, in_domain);
    }
    if (STORES_STEP) {
        write_step(index, tried.step);
        smooth_trial_terms(here, tried.step, in_domain);
    }
    return tried.step;
}
