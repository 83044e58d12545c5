// Sums <sigma(g + t s) - sigma(g), s> of each t that a pass looks at.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> direction: array<real>;

fn point(index: u32, on_surface: bool) {
    if (on_surface) {
        let g = gap[index];
        let s = trial_step(open_gap(g), 0.0, real(scalars.trial) * direction[index], real(scalars.restore), true);
        for (var place = 0u; place < 4u; place = place + 1u) {
            let change = traction_change(g, real(scalars.reached[place]) * s);
            add_sum(place, wide(change) * wide(s));
        }
    }
}
