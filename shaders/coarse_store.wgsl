// Stores the lines times the weight: the long-wave part of z.
@group(1) @binding(0) var<storage, read> weight: array<f32>;
@group(1) @binding(1) var<storage, read_write> long_waves: array<f32>;

fn store_point(index: u32, on_surface: bool, line_value: f32) {
    long_waves[index] = weight[index] * line_value;
}
