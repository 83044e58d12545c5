// Sums <sigma(g + t s) - sigma(g), s>, the change of the energy of adhesion and its size.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> trial_of: array<real>;

fn point(index: u32, on_surface: bool) {
    if (on_surface) {
        let g = gap[index];
        let s = trial_of[index];
        let step = real(scalars.step) * s;
        let energy = energy_change(g, step);
        add_sum(0u, wide(traction_change(g, step)) * wide(s));
        add_sum(1u, wide(energy.x));
        add_sum(2u, wide(energy.y));
    }
}
