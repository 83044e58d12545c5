// How kernels see the law where the unknown g is the gap itself.
const CORRECTS: bool = false;

fn open_gap(g: f32) -> f32 {
    return g;
}

// The value of the unknown at which the surfaces touch.
fn closed_at() -> f32 {
    return 0.0;
}

// What the law adds to y; nothing on a pad.
fn attraction(g: f32, on_surface: bool) -> f32 {
    if (on_surface) {
        return law_traction(g);
    }
    return 0.0;
}

// What of a pressure enters the scale of the stopping measure.
fn weighed(pressure_here: f32) -> f32 {
    return pressure_here;
}

fn traction_change(g: f32, step: f32) -> f32 {
    return law_traction(g + step) - law_traction(g);
}

// The change of the energy of adhesion, and the size of what it was taken from.
fn energy_change(g: f32, step: f32) -> vec2<f32> {
    let energy = law_energy(g);
    return vec2<f32>(law_energy(g + step) - energy, abs(energy));
}
