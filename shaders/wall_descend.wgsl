// What both descents share: z on free points, yF renewed, and the sums for the conjugacy.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read> direction: array<real>;
@group(1) @binding(3) var<storage, read_write> descent: array<real>;
@group(1) @binding(4) var<storage, read_write> free_before: array<real>;

fn descend(index: u32, on_surface: bool, candidate: real) {
    let g = gap[index];
    let y_here = total(g, pressure[index], on_surface);
    let free = is_free(open_gap(g), y_here, on_surface);
    let z = select(0.0, candidate, free);
    let y = select(0.0, y_here, free);
    let d = wide(direction[index]);
    let change = wide(y) - wide(free_before[index]);
    add_sum(2u, d * change);
    if (free) {
        add_sum(0u, wide(z) * wide(y));
        add_sum(1u, wide(z) * change);
        add_sum(3u, d * wide(y));
        if (params.fixed_gap != 0u) {
            add_sum(4u, wide(z));
            add_sum(5u, wide(1.0));
            add_sum(6u, wide(y));
            add_sum(7u, change);
            add_sum(8u, d);
        }
    }
    descent[index] = z;
    free_before[index] = y;
}
