// The 9-3 law: sigma = (8 w / 3 eps) (r^3 - r^9) with r = eps / (gap + eps).

// Nearer than this share of the range r^9 would overflow what any load can balance.
const LAW_NEAREST: real = 0.02;

fn law_ratio(gap_here: real) -> real {
    let range = real(params.law_range);
    return range / max(gap_here + range, LAW_NEAREST * range);
}

fn law_traction(gap_here: real) -> real {
    let r = law_ratio(gap_here);
    let cube = r * r * r;
    let scale = 8.0 / 3.0 * law_factor * real(params.law_work) / real(params.law_range);
    return scale * (cube - cube * cube * cube);
}

fn law_energy(gap_here: real) -> real {
    let r = law_ratio(gap_here);
    let square = r * r;
    let eighth = square * square * square * square;
    return -law_factor * real(params.law_work) * (4.0 / 3.0 * square - 1.0 / 3.0 * eighth);
}

fn law_slope(gap_here: real) -> real {
    let range = real(params.law_range);
    let r = law_ratio(gap_here);
    let fourth = r * r * r * r;
    let tenth = fourth * fourth * r * r;
    return 8.0 / 3.0 * law_factor * real(params.law_work) / (range * range) * (9.0 * tenth - 3.0 * fourth);
}

fn law_bend(gap_here: real) -> real {
    let range = real(params.law_range);
    let r = law_ratio(gap_here);
    let square = r * r;
    let fifth = square * square * r;
    let scale = 8.0 / 3.0 * law_factor * real(params.law_work) / (range * range * range);
    return scale * fifth * (12.0 - 90.0 * (square * square * square));
}

// The gain of the traction over a step, to the rounding of the gain itself: by how much r^3 and r^9
// grow, as shares of themselves.
fn law_difference(gap_here: real, step: real) -> real {
    let range = real(params.law_range);
    let distance_here = gap_here + range;
    let nearest = LAW_NEAREST * range;
    if (distance_here <= nearest || distance_here + step <= nearest) {
        return law_traction(gap_here + step) - law_traction(gap_here);
    }
    let x = step / distance_here;
    let third = -x * (3.0 + x * (3.0 + x)) / ((1.0 + x) * (1.0 + x) * (1.0 + x));
    let ninth = third * (3.0 + third * (3.0 + third));
    let r = law_ratio(gap_here);
    let cube = r * r * r;
    let scale = 8.0 / 3.0 * law_factor * real(params.law_work) / range;
    return scale * (cube * third - cube * cube * cube * ninth);
}

// A gap, just below that of zero force or deeper, at which the law repels by at least this pressure, from the
// repulsive power alone. It bounds Newton's method, for which a root in single precision will do.
fn law_repelling_gap(pressure: real) -> real {
    let range = real(params.law_range);
    let load = max(pressure * 0.375 * range / (law_factor * real(params.law_work)), 0.0);
    return range * (real(pow(f32(1.3 * load + 2.5), -1.0 / 9.0)) - 1.0);
}
