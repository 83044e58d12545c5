// Twins: kernel/measure.rs.
fn residual_terms(here: Here, in_domain: bool) {
    if (!in_domain) {
        add_sum(VIOLATION, wide(here.y) * wide(here.y));
        return;
    }
    let found = violation(here);
    let off = wide(found.violation);
    let pressed = wide(weighed(found.reaction));
    let pulled = wide(weighed(found.traction));
    add_sum(VIOLATION, off * off);
    add_sum(PRESSURES, (pressed * pressed + pulled * pulled));
    least(LEAST_GAP, wide(here.open));
    add_sum(GAP_SQUARES, wide(here.gap) * wide(here.gap));
}
