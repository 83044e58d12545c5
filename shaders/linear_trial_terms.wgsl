// The terms of a trial s0 before the mean gap is restored; `bent` is K g. Twins: kernel/trial.rs.
fn linear_trial_terms(tried: Tried, here: Here, bent: real) {
    let s = wide(tried.step);
    let g = wide(here.open);
    add_sum(SLOPE, s * wide(here.y));
    if (here.open > 0.0) {
        most(CLOSING, wide(-tried.step / here.open));
    }
    most(LARGEST_STEP, s);
    least(LEAST_STEP, s);
    most(CUT, select(wide(0.0), wide(1.0), tried.cut));
    add_sum(STEP_SUM, s);
    add_sum(GAP_SUM, g);
    add_sum(GAP_SLOPE, g * wide(here.y));
    add_sum(STEP_GAP_CURVATURE, s * wide(bent));
    add_sum(GAP_CURVATURE, g * wide(bent));
}
