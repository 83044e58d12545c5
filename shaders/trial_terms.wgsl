// The terms of a trial step. Twins: kernel/trial.rs.
fn trial_terms(tried: Tried, here: Here, in_domain: bool) {
    let s = wide(tried.step);
    into_slope(s * wide(here.y));
    if (in_domain && touches(here.open, tried.step)) {
        into_first_touch(wide(here.open) / -s);
    }
    into_largest_step(s);
    into_least_step(s);
    into_cut(select(wide(0.0), wide(1.0), tried.cut));
}

// What a smooth law's trial asks besides: step length 1, as a search would evaluate it.
fn smooth_trial_terms(here: Here, step: real, in_domain: bool) {
    let s = wide(step);
    into_elastic_slope(s * wide(here.elastic));
    if (!in_domain) {
        return;
    }
    let energy = energy_change(here.gap, step);
    into_change_at_first(wide(change(here.gap, step)) * s);
    into_energy_change(wide(energy.x));
    into_energy_size(wide(energy.y));
}
