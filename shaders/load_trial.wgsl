// Fills the rows of a transform with the trial step brought back to the prescribed mean gap.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let correction = real(scalars.mean_gap_correction);
    // A trial that nothing brings back is lost: one that moves and does not descend.
    if (!STORES_STEP && !(correction > -1.0 && correction < 1.0)) {
        into_largest_step(wide(1.0));
        into_cut(wide(0.0));
        return 0.0;
    }
    let here = here_at(read_gap(index), read_pressure(index) + real(scalars.mean_pressure), in_domain);
    if (STORES_STEP) {
        let step = corrected_step(here, read_step(index), correction, in_domain);
        write_step(index, step);
        trial_terms(Tried(step, false), here, in_domain);
        smooth_trial_terms(here, step, in_domain);
        return step;
    }
    let tried = step_at(here, real(scalars.trial_length) * read_direction(index), correction, in_domain);
    trial_terms(tried, here, in_domain);
    return tried.step;
}
