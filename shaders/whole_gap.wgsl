// How kernels see the law where the unknown g is the gap itself.
const CORRECTS: bool = false;

fn open_gap(g: real) -> real {
    return g;
}

// The value of the unknown at which the surfaces touch.
fn closed_at() -> real {
    return 0.0;
}

// What the law adds to y; nothing on a pad.
fn attraction(g: real, on_surface: bool) -> real {
    if (on_surface) {
        return law_traction(g);
    }
    return 0.0;
}

// What of a pressure enters the scale of the stopping measure.
fn weighed(pressure_here: real) -> real {
    return pressure_here;
}

fn traction_change(g: real, step: real) -> real {
    return law_traction(g + step) - law_traction(g);
}

// The change of the energy of adhesion, and the size of what it was taken from.
fn energy_change(g: real, step: real) -> vec2<real> {
    let energy = law_energy(g);
    return vec2<real>(law_energy(g + step) - energy, abs(energy));
}
