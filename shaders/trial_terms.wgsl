// The terms of a trial step. Twins: kernel/trial.rs.
fn trial_terms(tried: Tried, here: Here, in_domain: bool) {
    let s = wide(tried.step);
    add_sum(SLOPE, s * wide(here.y));
    if (in_domain && touches(here.open, tried.step)) {
        least(FIRST_TOUCH, wide(here.open) / -s);
    }
    most(LARGEST_STEP, s);
    least(LEAST_STEP, s);
    most(CUT, select(wide(0.0), wide(1.0), tried.cut));
}

// What a smooth law's trial asks besides: step length 1, as a search would evaluate it.
fn smooth_trial_terms(here: Here, step: real, in_domain: bool) {
    let s = wide(step);
    add_sum(ELASTIC_SLOPE, s * wide(here.elastic));
    if (!in_domain) {
        return;
    }
    let energy = energy_change(here.gap, step);
    add_sum(CHANGE_AT_FIRST, wide(change(here.gap, step)) * s);
    add_sum(ENERGY_CHANGE, wide(energy.x));
    add_sum(ENERGY_SIZE, wide(energy.y));
}
