// How kernels see the law where the unknown is the gap itself. Twins: law/mod.rs,
// law/adhesion_map.rs.
fn open(gap: real) -> real {
    return gap;
}

// The value of the unknown at which the surfaces touch.
fn closed_gap() -> real {
    return 0.0;
}

fn traction(gap: real) -> real {
    return law_traction(gap);
}

fn slope(gap: real) -> real {
    return law_slope(gap);
}

// What of a pressure enters the scale of the stopping measure.
fn weighed(pressure: real) -> real {
    return pressure;
}

fn corrects() -> bool {
    return false;
}

fn change(gap: real, moved: real) -> real {
    return law_traction(gap + moved) - law_traction(gap);
}

// The change of the energy of adhesion, and the size of what it was taken from.
fn energy_change(gap: real, moved: real) -> vec2<real> {
    let energy = law_energy(gap);
    return vec2<real>(law_energy(gap + moved) - energy, abs(energy));
}
