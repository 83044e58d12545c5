// What the kernels of the Lennard-Jones law share: its steep core takes the place of the wall.
// Below the gap of largest tension the iteration works in v = g - (sigma_max - sigma(g))/k, in which
// the core is no stiffer than k. With D = max(sigma'(g), 0): dg = S2 dv, S2 = k/(k + D).
const NEWTON_STEPS: u32 = 25u;

// D; 0 on a pad.
fn hardening(g: real, on_surface: bool) -> real {
    if (on_surface) {
        return max(law_slope(open_gap(g)), 0.0);
    }
    return 0.0;
}

// S2; 1 on a pad.
fn share_of(g: real, on_surface: bool) -> real {
    let stiffness = real(params.core_stiffness);
    return stiffness / (stiffness + hardening(g, on_surface));
}

// v.
fn variable(g: real) -> real {
    if (g < real(params.law_peak_gap)) {
        return g - (law_factor * real(params.law_peak) - law_traction(g)) / real(params.core_stiffness);
    }
    return g;
}

// The gap at a value of v, by Newton's method from the tangent at `g`.
fn gap_at(goal: real, g: real) -> real {
    let peak_gap = real(params.law_peak_gap);
    if (goal >= peak_gap) {
        return goal;
    }
    // v is concave here: from the left every step stays on the left of the root, so only the start
    // needs a bound, which the repulsive power alone gives. A root in single precision will do for it.
    let range = real(params.law_range);
    let load = max((real(params.core_stiffness) * (peak_gap - goal) - law_factor * real(params.law_peak)) * 0.375 * range / (law_factor * real(params.law_work)), 0.0);
    let bound = range * (real(pow(f32(1.3 * load + 2.5), -1.0 / 9.0)) - 1.0);
    let nearness = real(wide(2.0) * params.epsilon) * range;
    var x = min(max(g + (goal - variable(g)) * share_of(g, true), bound), peak_gap);
    for (var count = 0u; count < NEWTON_STEPS; count = count + 1u) {
        let error = variable(x) - goal;
        let next = min(max(x - error * share_of(x, true), bound), peak_gap);
        let moved = abs(next - x);
        x = next;
        if (moved <= nearness) {
            break;
        }
    }
    return x;
}

// The terms of the stopping measure.
fn add_residual(g: real, y: real, traction: real, on_surface: bool) {
    add_sum(0u, wide(y) * wide(y));
    if (on_surface) {
        let pull = wide(weighed(traction));
        let open = wide(open_gap(g));
        add_sum(1u, pull * pull);
        if (open < sums[2]) {
            sums[2] = open;
        }
        add_sum(3u, wide(g) * wide(g));
    }
}

// What the descent in v makes of a point.
struct Descent {
    // S2 y.
    y: real,
    // z / S2: the long-range part, and the local part that the core's own stiffness answers.
    z: real,
    s2: real,
}

fn descent_in_v(g: real, p: real, line_value: real, on_surface: bool) -> Descent {
    let y = p + real(scalars.mean_pressure) + attraction(g, on_surface);
    let hard = hardening(g, on_surface);
    let stiffness = real(params.core_stiffness);
    let s2 = stiffness / (stiffness + hard);
    return Descent(s2 * y, line_value + hard / stiffness * y / (hard + stiffness), s2);
}

// The new direction.
fn new_direction(z: real, d: real) -> real {
    return real(scalars.descent) * z + real(scalars.memory) * d + real(scalars.shift);
}

// The trial step of a way in v.
fn step_in_v(g: real, way: real, on_surface: bool) -> real {
    if (!on_surface) {
        return way;
    }
    if (CORRECTS) {
        // A correction is short: v follows its slope.
        return share_of(g, true) * way;
    }
    return gap_at(variable(g) + way, g) - g;
}

// The sums over a trial step: slots as `accept` reads them, then those of a search at step 1.
fn add_trial(g: real, p: real, s: real, on_surface: bool) {
    let elastic = p + real(scalars.mean_pressure);
    let step = wide(s);
    let all = elastic + attraction(g, on_surface);
    add_sum(0u, step * wide(all));
    if (step > sums[2]) {
        sums[2] = step;
    }
    if (step < sums[3]) {
        sums[3] = step;
    }
    if (!on_surface) {
        // On a pad a base's residual is no law's: the search will not count it.
        add_sum(5u, step * wide(all));
        return;
    }
    add_sum(5u, step * wide(elastic));
    let energy = energy_change(g, s);
    add_sum(6u, wide(traction_change(g, s)) * step);
    add_sum(7u, wide(energy.x));
    add_sum(8u, wide(energy.y));
}

// The step length; 0 after a lost trial, which leaves all as it is.
fn taken() -> real {
    return select(0.0, real(scalars.step), scalars.accepted != 0u);
}

// S2 y before a step.
fn before_step(g: real, p: real, on_surface: bool) -> real {
    return share_of(g, on_surface) * (p + real(scalars.mean_pressure) + attraction(g, on_surface));
}

// S2 y, with the stopping measure summed on the way.
fn free_line(g: real, p: real, on_surface: bool) -> real {
    let traction = attraction(g, on_surface);
    let y = p + real(scalars.mean_pressure) + traction;
    add_residual(g, y, traction, on_surface);
    return share_of(g, on_surface) * y;
}

// The terms of the mean pressure that a held gap asks for.
fn add_balance(g: real, p: real, on_surface: bool) {
    let s2 = share_of(g, on_surface);
    add_sum(0u, wide(s2 * (p + attraction(g, on_surface))));
    add_sum(1u, wide(s2));
}
