// Sums <sigma(g + t s) - sigma(g), s> of each t that a pass looks at; below zero the pressure does not change.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> direction: array<real>;
@group(1) @binding(2) var<storage, read> pressure: array<real>;

fn point(index: u32, on_surface: bool) {
    let g = gap[index];
    let y = total(g, pressure[index], on_surface);
    if (on_surface && !goes_down(g, y)) {
        let s = trial_step(g, y, real(scalars.trial) * direction[index], real(scalars.restore), true);
        for (var place = 0u; place < 4u; place = place + 1u) {
            let change = traction_change(g, real(scalars.reached[place]) * s);
            add_sum(place, wide(change) * wide(s));
        }
    }
}
