// Twins: kernel/measure.rs.
fn residual_terms(here: Here, in_domain: bool) {
    if (!in_domain) {
        into_violation(wide(here.y) * wide(here.y));
        return;
    }
    let found = violation(here);
    let off = wide(found.violation);
    let pressed = wide(weighed(found.reaction));
    let pulled = wide(weighed(found.traction));
    into_violation(off * off);
    into_pressures((pressed * pressed + pulled * pulled));
    into_least_gap(wide(here.open));
    into_gap_squares(wide(here.gap) * wide(here.gap));
}
