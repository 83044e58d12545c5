// Sums <sigma(g + t s) - sigma(g), s>.
@group(1) @binding(0) var<storage, read> gap: array<f32>;
@group(1) @binding(1) var<storage, read> direction: array<f32>;

fn point(index: u32, on_surface: bool) {
    if (on_surface) {
        let g = gap[index];
        let s = trial_step(open_gap(g), 0.0, f32(scalars.trial) * direction[index], f32(scalars.restore), true);
        let change = traction_change(g, f32(scalars.step) * s);
        add_sum(0u, wide(change) * wide(s));
    }
}
