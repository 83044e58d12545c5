// What the kernels of a solid that flows at its hardness share; the same words as in `wall`. Below
// zero a gap is a depth that has flowed, and y = p + mean_pressure - hardness. A closed point that
// rests has y = 0; one that may move has the y of the side to which it may.
fn total(g: real, p: real, on_surface: bool) -> real {
    let elastic = p + real(scalars.mean_pressure);
    if (!on_surface) {
        return elastic;
    }
    let flow = elastic - real(params.hardness);
    if (g < 0.0) {
        return flow;
    }
    let y = elastic + law_traction(g);
    if (g > 0.0 || y < 0.0) {
        return y;
    }
    return max(flow, 0.0);
}

fn is_free(g: real, y: real, on_surface: bool) -> bool {
    return !on_surface || g != 0.0 || y != 0.0;
}

// Whether a point is below zero or may only go there.
fn goes_down(g: real, y: real) -> bool {
    return g < 0.0 || (g == 0.0 && y > 0.0);
}

// s = s0 + restore (g + s0) with s0 the way to clip(g + moved); below zero with the opposite sign of
// restore, so that a held mean is kept on either side.
fn trial_step(g: real, y: real, moved: real, restore: real, on_surface: bool) -> real {
    if (!on_surface) {
        return moved;
    }
    if (goes_down(g, y)) {
        let down = min(moved, -g);
        return down - restore * (g + down);
    }
    let up = max(moved, -g);
    return up + restore * (g + up);
}

// The terms of the stopping measure, and y on free points, 0 elsewhere.
fn free_line(g: real, p: real, on_surface: bool) -> real {
    let elastic = p + real(scalars.mean_pressure);
    if (!on_surface) {
        add_sum(0u, wide(elastic) * wide(elastic));
        return elastic;
    }
    let traction = attraction(max(g, 0.0), true);
    let y = elastic + traction;
    let middle = max(min(y, g * real(params.stiffness_max)), elastic - real(params.hardness));
    let violation = wide(middle);
    add_sum(0u, violation * violation);
    let reaction = wide(select(max(y, 0.0), 0.0, g > 0.0));
    add_sum(1u, (reaction * reaction + wide(traction) * wide(traction)));
    if (wide(g) < sums[2]) {
        sums[2] = wide(g);
    }
    add_sum(3u, wide(g) * wide(g));
    return total(g, p, true);
}

// The new direction: zero where the point is not free.
fn new_direction(z: real, d: real, free: bool) -> real {
    if (!free) {
        return 0.0;
    }
    return real(scalars.descent) * z + real(scalars.memory) * d + real(scalars.shift);
}

// The sums over a trial step; slots as `accept` reads them.
fn add_trial(s: real, y: real, g: real, moved: real, on_surface: bool) {
    let step = wide(s);
    add_sum(0u, step * wide(y));
    let closes = (g >= 0.0 && s < 0.0) || (g < 0.0 && s > 0.0);
    if (closes && on_surface) {
        let ratio = wide(g) / -step;
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
    let x = g + moved;
    if (on_surface && select((x < 0.0), (x > 0.0), goes_down(g, y))) {
        sums[4] = wide(1.0);
    }
}

// The gap after the step t s: no point crosses zero.
fn land(g: real, y: real, s: real, t: real) -> real {
    let moved = g + t * s;
    let snap = real(scalars.snap);
    if (goes_down(g, y)) {
        return select(moved, 0.0, moved > 0.0 || (s > 0.0 && moved > -snap));
    }
    return select(moved, 0.0, moved < 0.0 || (s < 0.0 && moved < snap));
}

// What adds to the elastic pressure at a gap: below zero the solid's own hardness.
fn pull_at(g: real, on_surface: bool) -> real {
    let below = on_surface && g < 0.0;
    return select(attraction(max(g, 0.0), on_surface), -real(params.hardness), below);
}

// The terms of the mean pressure that a held gap asks for.
fn add_balance(g: real, p: real, on_surface: bool) {
    let y = wide(p + pull_at(g, on_surface));
    let weight = wide(abs(g));
    add_sum(0u, weight * y);
    add_sum(1u, weight);
    if (y < sums[2]) {
        sums[2] = y;
    }
}
