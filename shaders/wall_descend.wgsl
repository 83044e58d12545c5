// What both descents share: z on free points, yF renewed, and the sums for the conjugacy.
@group(1) @binding(0) var<storage, read> gap: array<f32>;
@group(1) @binding(1) var<storage, read> pressure: array<f32>;
@group(1) @binding(2) var<storage, read> direction: array<f32>;
@group(1) @binding(3) var<storage, read_write> descent: array<f32>;
@group(1) @binding(4) var<storage, read_write> free_before: array<f32>;

fn descend(index: u32, on_surface: bool, candidate: f32) {
    let g = gap[index];
    let y_here = total(g, pressure[index], on_surface);
    let free = is_free(open_gap(g), y_here, on_surface);
    let z = select(0.0, candidate, free);
    let y = select(0.0, y_here, free);
    let d = wide(direction[index]);
    let change = wide(y) - wide(free_before[index]);
    sums[2] = sums[2] + d * change;
    if (free) {
        sums[0] = sums[0] + wide(z) * wide(y);
        sums[1] = sums[1] + wide(z) * change;
        sums[3] = sums[3] + d * wide(y);
        if (params.fixed_gap != 0u) {
            sums[4] = sums[4] + wide(z);
            sums[5] = sums[5] + wide(1.0);
            sums[6] = sums[6] + wide(y);
            sums[7] = sums[7] + change;
            sums[8] = sums[8] + d;
        }
    }
    descent[index] = z;
    free_before[index] = y;
}
