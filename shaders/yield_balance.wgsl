// The sums that give the mean pressure under a held mean gap.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;

fn point(index: u32, on_surface: bool) {
    let g = gap[index];
    let below = on_surface && g < 0.0;
    let pull = select(attraction(max(g, 0.0), on_surface), -real(params.hardness), below);
    let y = wide(pressure[index] + pull);
    let weight = wide(abs(g));
    add_sum(0u, weight * y);
    add_sum(1u, weight);
    if (y < sums[2]) {
        sums[2] = y;
    }
}
