// The sums that give the mean pressure under a held mean gap.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;

fn point(index: u32, on_surface: bool) {
    let g = gap[index];
    let y = wide(pressure[index] + attraction(g, on_surface));
    let open = wide(open_gap(g));
    add_sum(0u, open * y);
    add_sum(1u, open);
    if (y < sums[2]) {
        sums[2] = y;
    }
}
