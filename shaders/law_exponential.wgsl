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
