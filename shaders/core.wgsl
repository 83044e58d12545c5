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
