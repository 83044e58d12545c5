// A point as the kernels see it. Twins: kernel/constraint.rs.
struct Here {
    // The unknown, and the gap itself.
    gap: real,
    open: real,
    // p + mean_pressure.
    elastic: real,
    // The attraction.
    pull: real,
    // The slope of the energy to the side to which the point may move.
    y: real,
    free: bool,
    // By how much the unknown changes with the variable of the iteration.
    weight: real,
    // D.
    hardening: real,
}

// A point of its gap and p + mean_pressure; those of a pad have neither constraint nor law.
fn here_at(gap: real, elastic: real, in_domain: bool) -> Here {
    if (in_domain) {
        return state(gap, elastic);
    }
    return Here(gap, open(gap), elastic, real(0.0), elastic, true, real(1.0), real(0.0));
}

// What r is on a free point in exact balance: less than any rounding, and not 0.
const BALANCED: real = 1.2e-38;

// y on free points in the measure of the iteration's variable, 0 elsewhere and nowhere else.
fn projected_residual(here: Here) -> real {
    let residual = here.weight * here.y;
    return select(real(0.0), select(residual, BALANCED, residual == 0.0), here.free);
}

// What a point adds to the stopping measure.
struct Violation {
    violation: real,
    reaction: real,
    traction: real,
}

// A trial step, and whether the constraint cut it.
struct Tried {
    step: real,
    cut: bool,
}

// max(y, 0) where the point is closed.
fn reaction(open: real, y: real) -> real {
    return select(max(y, 0.0), real(0.0), open > 0.0);
}
