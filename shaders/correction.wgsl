// How kernels see the law where the unknown g is the correction of a base gap, whose residual y is
// known: differences are taken without cancellation, so that all is relative to the correction.
const CORRECTS: bool = true;

fn open_gap(g: real) -> real {
    return base_gap + g;
}

// The value of the unknown at which the surfaces touch.
fn closed_at() -> real {
    return -base_gap;
}

// All of y that does not come from the correction's own pressure; a pad has no law.
fn attraction(g: real, on_surface: bool) -> real {
    if (on_surface) {
        return base_residual + law_difference(base_gap, g);
    }
    return base_residual;
}

// The scale of the stopping measure is the base's.
fn weighed(pressure_here: real) -> real {
    return 0.0;
}

fn traction_change(g: real, step: real) -> real {
    return law_difference(base_gap + g, step);
}

// The change of the energy to first order exactly, the rest by Simpson's rule over the step, which
// is short beside the range of a law; and the size of the first order.
fn energy_change(g: real, step: real) -> vec2<real> {
    let first = step * attraction(g, true);
    let middle = traction_change(g, 0.5 * step);
    let rest = step / 6.0 * (4.0 * middle + traction_change(g, step));
    return vec2<real>(first + rest, abs(first));
}
