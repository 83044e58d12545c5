// Twins: kernel/trial.rs. The new direction: zero where the point is not free.
fn new_direction(z: real, direction: real, free: bool) -> real {
    if (!free) {
        return 0.0;
    }
    return real(scalars.descent_factor) * z + real(scalars.beta) * direction + real(scalars.mean_gap_shift);
}

// The trial step of a point; a pad has no constraint.
fn step_at(here: Here, moved: real, correction: real, in_domain: bool) -> Tried {
    if (in_domain) {
        return trial_step(here, moved, correction);
    }
    return Tried(moved, false);
}
