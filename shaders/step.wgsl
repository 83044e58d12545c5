// A point after a step, and y on free points before it.
struct Moved {
    gap: real,
    pressure: real,
    before: real,
}

// Takes the step of a point, where its trial was not lost; `answer` is the pressure that it takes.
fn step_from(g: real, p: real, d: real, answer: real, on_surface: bool) -> Moved {
    let y = total(g, p, on_surface);
    let open = open_gap(g);
    let before = select(0.0, y, is_free(open, y, on_surface));
    if (scalars.accepted == 0u) {
        return Moved(g, p, before);
    }
    let t = real(scalars.step);
    let s = trial_step(open, y, real(scalars.trial) * d, real(scalars.restore), on_surface);
    var moved = g + t * s;
    if (on_surface) {
        moved = land(g, y, s, t);
    }
    return Moved(moved, p + t * answer, before);
}
