// No attraction at all.
fn law_traction(gap_here: f32) -> f32 {
    return 0.0;
}

fn law_energy(gap_here: f32) -> f32 {
    return 0.0;
}

fn law_slope(gap_here: f32) -> f32 {
    return 0.0;
}
