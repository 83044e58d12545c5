// Brings the base's mean gap back to the one that is held, over a steep core.
@group(1) @binding(0) var<storage, read_write> gap: array<real>;

fn point(index: u32, on_surface: bool) {
    let g = gap[index];
    gap[index] = g - real(scalars.restore) * share_of(g, on_surface);
}
