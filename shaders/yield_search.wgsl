// Sums <sigma(g + t s) - sigma(g), s>; below zero the pressure does not change.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> direction: array<real>;
@group(1) @binding(2) var<storage, read> pressure: array<real>;

fn point(index: u32, on_surface: bool) {
    let g = gap[index];
    let y = total(g, pressure[index], on_surface);
    if (on_surface && !goes_down(g, y)) {
        let s = trial_step(g, y, real(scalars.trial) * direction[index], real(scalars.restore), true);
        let change = traction_change(g, real(scalars.step) * s);
        add_sum(0u, wide(change) * wide(s));
    }
}
