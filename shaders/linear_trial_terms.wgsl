// The terms of a trial s0 before the mean gap is restored; `bent` is K g. Twins: kernel/trial.rs.
fn linear_trial_terms(tried: Tried, here: Here, bent: real) {
    let s = wide(tried.step);
    let g = wide(here.open);
    into_slope(s * wide(here.y));
    if (here.open > 0.0) {
        into_closing(wide(-tried.step / here.open));
    }
    into_largest_step(s);
    into_least_step(s);
    into_cut(select(wide(0.0), wide(1.0), tried.cut));
    into_step_sum(s);
    into_gap_sum(g);
    into_gap_slope(g * wide(here.y));
    into_step_gap_curvature(s * wide(bent));
    into_gap_curvature(g * wide(bent));
}
