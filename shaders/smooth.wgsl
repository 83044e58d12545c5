// A law that repels by itself: no constraint, and another variable in which its steep core is not stiff.
// Below the gap of largest tension the iteration works in v = g - (sigma_max - sigma(g))/k, in which
// the core is no stiffer than k. With D = max(sigma'(g), 0): dg = S2 dv, S2 = k/(k + D).
// Twins: kernel/smooth.rs, kernel/constraint.rs, kernel/seek.rs.
const STORES_STEP: bool = true;
const MOST_STEPS: u32 = 25u;
// A step of Halley's method leaves an error of a constant times its third power. In shares of the distance the constant is 7
// where the core is steep, so that the step after one of this many cube roots of the rounding error would be below rounding.
const LAST_STEP: f32 = 0.4;

// D.
fn hardening(gap: real) -> real {
    return max(slope(gap), 0.0);
}

// S2.
fn share(gap: real) -> real {
    let stiffness = real(params.smooth_stiffness);
    return stiffness / (stiffness + hardening(gap));
}

// v.
fn variable(gap: real) -> real {
    if (gap < real(params.law_peak_gap)) {
        return gap - (law_factor * real(params.law_peak) - traction(gap)) / real(params.smooth_stiffness);
    }
    return gap;
}

// The gap at a value of v by the tangent at another gap.
fn by_tangent(goal: real, gap: real) -> real {
    return min(gap - (variable(gap) - goal) * share(gap), real(params.law_peak_gap));
}

// One step of Halley's method from a gap to that at a value of v, within the core: with v' and v'' there.
fn by_halley(goal: real, gap: real, bound: real) -> real {
    let error = variable(gap) - goal;
    let stiffness = real(params.smooth_stiffness);
    let slope_here = 1.0 + hardening(gap) / stiffness;
    let half_bend = 0.5 * law_bend(gap) / stiffness;
    let next = gap - error * slope_here / (slope_here * slope_here - error * half_bend);
    return min(max(next, bound), real(params.law_peak_gap));
}

// The gap at a value of v, from the tangent at `gap`.
fn gap_at(goal: real, gap: real) -> real {
    let peak_gap = real(params.law_peak_gap);
    if (goal >= peak_gap) {
        return goal;
    }
    // v is concave here, so that the tangent leads to the left of what is sought. A start that is too far is bounded by what
    // the repulsive power alone gives.
    let load = real(params.smooth_stiffness) * (peak_gap - goal) - law_factor * real(params.law_peak);
    var x = max(by_tangent(goal, gap), law_repelling_gap(load));
    let bound = x;
    let last_step = LAST_STEP * pow(f32(params.epsilon), 1.0 / 3.0);
    for (var count = 0u; count < MOST_STEPS; count = count + 1u) {
        let next = by_halley(goal, x, bound);
        let moved = abs(next - x);
        x = next;
        if (moved <= real(last_step) * (x + real(params.law_range))) {
            break;
        }
    }
    return x;
}

fn state(gap: real, elastic: real) -> Here {
    let pull = traction(gap);
    let stiffness = real(params.smooth_stiffness);
    let hardening_here = hardening(gap);
    let weight = stiffness / (stiffness + hardening_here);
    return Here(gap, open(gap), elastic, pull, elastic + pull, true, weight, hardening_here);
}

fn violation(here: Here) -> Violation {
    return Violation(here.y, real(0.0), here.pull);
}

// z / S2: the long-range part, and the local part that the core's own stiffness answers.
fn preconditioned(here: Here, line: real) -> real {
    let stiffness = real(params.smooth_stiffness);
    return line + here.hardening / stiffness * here.y / (here.hardening + stiffness);
}

fn goes_down(open: real, y: real) -> bool {
    return false;
}

// The change of g as v moves.
fn trial_step(here: Here, moved: real, correction: real) -> Tried {
    if (corrects()) {
        // A correction is short: v follows its slope.
        return Tried(here.weight * moved, false);
    }
    return Tried(gap_at(variable(here.gap) + moved, here.gap) - here.gap, false);
}

fn corrected_step(here: Here, step: real, correction: real, in_domain: bool) -> real {
    if (in_domain) {
        return step - correction * share(here.gap + step);
    }
    return step - correction;
}

fn touches(open: real, step: real) -> bool {
    return false;
}

fn land(here: Here, step: real, t: real) -> real {
    return here.gap + t * step;
}

fn pressure_weight(here: Here) -> real {
    return here.weight;
}

fn corrected_gap(gap: real, correction: real) -> real {
    return gap + correction;
}

fn net_traction(here: Here) -> real {
    return here.pull;
}
