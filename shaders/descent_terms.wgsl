// What beta is made of. Twins: kernel/descent.rs.
fn descent_terms(z: real, residual: real, previous: real) {
    into_z_residual(wide(z) * wide(residual));
    into_z_change(wide(z) * (wide(residual) - wide(previous)));
}

// What the direction adds to it, and what takes the means off, in the measure `weight` of the free points.
fn mean_gap_descent_terms(z: real, residual: real, previous: real, direction: real, weight: real, free: bool) {
    let d = wide(direction);
    let r = wide(residual);
    let w = wide(weight);
    let change_here = r - wide(previous);
    into_direction_change(d * change_here);
    if (free) {
        into_direction_residual(d * r);
        into_weighted_z(w * wide(z));
        into_free_weight(w);
        into_free_residual(r);
        into_free_change(change_here);
        into_weighted_direction(w * d);
    }
}
