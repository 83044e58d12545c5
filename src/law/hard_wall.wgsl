// No attraction at all.
fn law_traction(gap_here: real) -> real {
    return 0.0;
}

fn law_energy(gap_here: real) -> real {
    return 0.0;
}

fn law_slope(gap_here: real) -> real {
    return 0.0;
}

// The gain of the traction over a step, to the rounding of the gain itself.
fn law_difference(gap_here: real, step: real) -> real {
    return 0.0;
}

// A law with a wall has no repulsion of its own.
fn law_repelling_gap(pressure: real) -> real {
    return 0.0;
}

// Asked of a law without a wall alone.
fn law_bend(gap_here: real) -> real {
    return 0.0;
}
