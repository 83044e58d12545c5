// The sums that give the mean pressure under a held mean gap.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;

fn point(index: u32, on_surface: bool) {
    let g = gap[index];
    let s2 = share_of(g, on_surface);
    add_sum(0u, wide(s2 * (pressure[index] + attraction(g, on_surface))));
    add_sum(1u, wide(s2));
}
