// The terms of the mean pressure that a prescribed mean gap takes. Twins: kernel/update.rs.
fn balance_terms(gap: real, pressure: real, in_domain: bool) {
    let here = here_at(gap, pressure, in_domain);
    var pull = here.pull;
    if (in_domain) {
        pull = net_traction(here);
    }
    let y = wide(pressure + pull);
    let weight = wide(pressure_weight(here));
    into_weighted_pressure(weight * y);
    into_pressure_weight(weight);
    into_least_pressure(y);
}
