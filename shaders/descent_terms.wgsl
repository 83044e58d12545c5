// What beta is made of. Twins: kernel/descent.rs.
fn descent_terms(z: real, residual: real, previous: real) {
    add_sum(Z_RESIDUAL, wide(z) * wide(residual));
    add_sum(Z_CHANGE, wide(z) * (wide(residual) - wide(previous)));
}

// What the direction adds to it, and what takes the means off, in the measure `weight` of the free points.
fn mean_gap_descent_terms(z: real, residual: real, previous: real, direction: real, weight: real, free: bool) {
    let d = wide(direction);
    let r = wide(residual);
    let w = wide(weight);
    let change_here = r - wide(previous);
    add_sum(DIRECTION_CHANGE, d * change_here);
    if (free) {
        add_sum(DIRECTION_RESIDUAL, d * r);
        add_sum(WEIGHTED_Z, w * wide(z));
        add_sum(FREE_WEIGHT, w);
        add_sum(FREE_RESIDUAL, r);
        add_sum(FREE_CHANGE, change_here);
        add_sum(WEIGHTED_DIRECTION, w * d);
    }
}
