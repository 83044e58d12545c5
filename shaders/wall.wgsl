// What the kernels of the laws with a hard wall share. g gap, p elastic pressure,
// y = p + mean_pressure + sigma(g); points of a pad have no wall and no law: they are always free.
fn total(g: real, p: real, on_surface: bool) -> real {
    return p + real(scalars.mean_pressure) + attraction(g, on_surface);
}

fn is_free(open: real, y: real, on_surface: bool) -> bool {
    return !on_surface || open > 0.0 || y < 0.0;
}

// s = s0 + restore (g + s0) with s0 = max(-g, moved), without a wall on the pad. Where a floor flows,
// y tells to which side a closed point may move.
fn trial_step(open: real, y: real, moved: real, restore: real, on_surface: bool) -> real {
    if (!on_surface) {
        return moved;
    }
    let s = max(moved, -open);
    return s + restore * (open + s);
}

// The terms of the stopping measure.
fn add_residual(g: real, y: real, traction: real, on_surface: bool) {
    if (!on_surface) {
        add_sum(0u, wide(y) * wide(y));
        return;
    }
    let open = open_gap(g);
    let violation = wide(min(y, open * real(params.stiffness_max)));
    add_sum(0u, violation * violation);
    let reaction = wide(weighed(select(max(y, 0.0), 0.0, open > 0.0)));
    let pull = wide(weighed(traction));
    add_sum(1u, (reaction * reaction + pull * pull));
    if (wide(open) < sums[2]) {
        sums[2] = wide(open);
    }
    add_sum(3u, wide(g) * wide(g));
}

// y on free points, 0 elsewhere, with the stopping measure summed on the way.
fn free_line(g: real, p: real, on_surface: bool) -> real {
    let traction = attraction(g, on_surface);
    let y = p + real(scalars.mean_pressure) + traction;
    add_residual(g, y, traction, on_surface);
    return select(0.0, y, is_free(open_gap(g), y, on_surface));
}

// The new direction: zero where the point is not free.
fn new_direction(z: real, d: real, free: bool) -> real {
    if (!free) {
        return 0.0;
    }
    return real(scalars.descent) * z + real(scalars.memory) * d + real(scalars.shift);
}

// The sums over a trial step; slots as `accept` reads them.
fn add_trial(s: real, y: real, open: real, moved: real, on_surface: bool) {
    let step = wide(s);
    add_sum(0u, step * wide(y));
    if (s < 0.0 && on_surface) {
        let ratio = wide(open) / -step;
        if (ratio < sums[1]) {
            sums[1] = ratio;
        }
    }
    if (step > sums[2]) {
        sums[2] = step;
    }
    if (step < sums[3]) {
        sums[3] = step;
    }
    if (on_surface && open + moved < 0.0) {
        sums[4] = wide(1.0);
    }
}
