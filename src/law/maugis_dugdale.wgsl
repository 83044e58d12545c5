// Constant tension up to about the range, then linear to zero over the width `taper` centred on it.
fn law_traction(gap_here: real) -> real {
    let peak = law_factor * real(params.law_peak);
    let range = real(params.law_range);
    let taper = real(params.law_taper);
    if (taper > 0.0) {
        return peak * clamp((range - gap_here) / taper + 0.5, 0.0, 1.0);
    }
    return select(0.0, peak, gap_here < range);
}

fn law_energy(gap_here: real) -> real {
    let peak = law_factor * real(params.law_peak);
    let range = real(params.law_range);
    let taper = real(params.law_taper);
    let half = 0.5 * taper;
    if (gap_here <= range - half) {
        return -peak * (range - gap_here);
    }
    if (gap_here < range + half) {
        let left = range + half - gap_here;
        return -peak * left * left / (2.0 * taper);
    }
    return 0.0;
}

fn law_slope(gap_here: real) -> real {
    let range = real(params.law_range);
    let taper = real(params.law_taper);
    let half = 0.5 * taper;
    if (gap_here > range - half && gap_here < range + half) {
        return -law_factor * real(params.law_peak) / taper;
    }
    return 0.0;
}

// The gain of the traction over a step, to the rounding of the gain itself: only the part of the way
// that lies on the taper counts.
fn law_difference(gap_here: real, step: real) -> real {
    let taper = real(params.law_taper);
    if (taper <= 0.0) {
        return law_traction(gap_here + step) - law_traction(gap_here);
    }
    let left = (real(params.law_range) - gap_here) / taper + 0.5;
    let moved = step / taper;
    var lost = min(max(moved, left - 1.0), left);
    if (left > 1.0) {
        lost = clamp(moved - (left - 1.0), 0.0, 1.0);
    } else if (left < 0.0) {
        lost = -clamp(left - moved, 0.0, 1.0);
    }
    return -law_factor * real(params.law_peak) * lost;
}

// A law with a wall has no repulsion of its own.
fn law_repelling_gap(pressure: real) -> real {
    return 0.0;
}

// Asked of a law without a wall alone.
fn law_bend(gap_here: real) -> real {
    return 0.0;
}
