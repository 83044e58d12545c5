// Turns the direction and sums the mean that the trial would have and its size (fixed mean gap).
@group(1) @binding(0) var<storage, read> gap: array<f32>;
@group(1) @binding(1) var<storage, read> pressure: array<f32>;
@group(1) @binding(2) var<storage, read> descent: array<f32>;
@group(1) @binding(3) var<storage, read_write> direction: array<f32>;

fn point(index: u32, on_surface: bool) {
    let g = gap[index];
    let y = total(g, pressure[index], on_surface);
    let d = new_direction(descent[index], direction[index], is_free(g, y, on_surface));
    direction[index] = d;
    let x = g + f32(scalars.trial) * d;
    let moved = select(max(x, 0.0), min(x, 0.0), goes_down(g, y));
    sums[0] = sums[0] + wide(moved);
    sums[1] = sums[1] + wide(g);
    sums[2] = sums[2] + wide(abs(moved));
}
