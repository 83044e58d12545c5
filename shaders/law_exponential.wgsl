// Tension that falls by e over each range.
fn law_traction(gap_here: f32) -> f32 {
    let range = f32(params.law_range);
    return law_factor * f32(params.law_work) / range * exp(-gap_here / range);
}

fn law_energy(gap_here: f32) -> f32 {
    return -law_factor * f32(params.law_work) * exp(-gap_here / f32(params.law_range));
}

fn law_slope(gap_here: f32) -> f32 {
    return -law_traction(gap_here) / f32(params.law_range);
}

// exp(x) - 1 without cancellation: the series where it is short.
fn exp_less_one(x: f32) -> f32 {
    if (abs(x) > 0.5) {
        return exp(x) - 1.0;
    }
    let tail = 1.0 + x / 5.0 * (1.0 + x / 6.0 * (1.0 + x / 7.0 * (1.0 + x / 8.0)));
    return x * (1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0 * tail)));
}

// The gain of the traction over a step, to the rounding of the gain itself.
fn law_difference(gap_here: f32, step: f32) -> f32 {
    return law_traction(gap_here) * exp_less_one(-step / f32(params.law_range));
}
