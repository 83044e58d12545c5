// Adds a correction found in single precision to the base, over a steep core.
@group(1) @binding(0) var<storage, read> correction: array<real>;
@group(1) @binding(1) var<storage, read_write> gap: array<real>;

fn point(index: u32, on_surface: bool) {
    let g = gap[index] + correction[index];
    gap[index] = g;
    add_sum(0u, wide(g) - scalars.offset);
    add_sum(1u, wide(share_of(g, on_surface)));
}
