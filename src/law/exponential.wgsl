// Tension that falls by e over each range.
fn law_traction(gap_here: real) -> real {
    let range = real(params.law_range);
    return law_factor * real(params.law_work) / range * exponential(-gap_here / range);
}

fn law_energy(gap_here: real) -> real {
    return -law_factor * real(params.law_work) * exponential(-gap_here / real(params.law_range));
}

fn law_slope(gap_here: real) -> real {
    return -law_traction(gap_here) / real(params.law_range);
}

// Ranges of a closing step beyond which its exponential may be past single precision. The gap it starts
// from then has next to no tension that could cancel.
const MOST_RANGES: real = 80.0;

// The gain of the traction over a step, to the rounding of the gain itself.
fn law_difference(gap_here: real, step: real) -> real {
    let ranges = -step / real(params.law_range);
    if (ranges > MOST_RANGES) {
        return law_traction(gap_here + step) - law_traction(gap_here);
    }
    return law_traction(gap_here) * exp_less_one(ranges);
}

// A law with a wall has no repulsion of its own.
fn law_repelling_gap(pressure: real) -> real {
    return 0.0;
}

// Asked of a law without a wall alone.
fn law_bend(gap_here: real) -> real {
    return 0.0;
}
