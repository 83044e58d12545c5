// A point after a step, and its projected residual before it. Twins: kernel/update.rs.
struct Moved {
    gap: real,
    pressure: real,
    previous: real,
}

// A point after the step along a direction, or by the kept trial step, which the elastic pressure `answer`s.
fn step_from(gap: real, pressure: real, moved: real, answer: real, in_domain: bool) -> Moved {
    let here = here_at(gap, pressure + real(scalars.mean_pressure), in_domain);
    let previous = projected_residual(here);
    // A lost trial leaves all as it is.
    if (scalars.accepted == 0u) {
        return Moved(gap, pressure, previous);
    }
    var step = moved;
    if (!STORES_STEP) {
        let way = real(scalars.trial_length) * moved;
        step = step_at(here, way, real(scalars.mean_gap_correction), in_domain).step;
    }
    let t = real(scalars.step);
    var after = gap + t * step;
    if (in_domain) {
        after = land(here, step, t);
    }
    return Moved(after, pressure + t * answer, previous);
}
