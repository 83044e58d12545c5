// How kernels see the law where the unknown is the correction of an outer gap, and the pressure starts at the
// residual of the outer state: differences are taken without cancellation, so that all is relative to the
// correction. Twins: law/correction.rs.
fn open(correction: real) -> real {
    return known_gap + correction;
}

// The value of the unknown at which the surfaces touch.
fn closed_gap() -> real {
    return -known_gap;
}

fn traction(correction: real) -> real {
    return law_difference(known_gap, correction);
}

fn slope(correction: real) -> real {
    return law_slope(known_gap + correction);
}

// The scale of the stopping measure is the outer state's.
fn weighed(pressure: real) -> real {
    return 0.0;
}

fn corrects() -> bool {
    return true;
}

fn change(correction: real, moved: real) -> real {
    return law_difference(known_gap + correction, moved);
}

// The change of the energy to first order exactly, the rest by Simpson's rule over the step, which
// is short beside the range of a law; and the size of the first order.
fn energy_change(correction: real, moved: real) -> vec2<real> {
    let first = moved * traction(correction);
    let middle = change(correction, 0.5 * moved);
    let rest = moved / 6.0 * (4.0 * middle + change(correction, moved));
    return vec2<real>(first + rest, abs(first));
}
