// Stores the square of the smoothed share of free points, clipped to [0, 1].
@group(1) @binding(0) var<storage, read_write> weight: array<real>;

fn store_point(index: u32, on_surface: bool, line_value: real) {
    let m = clamp(line_value, 0.0, 1.0);
    weight[index] = m * m;
}
