// Stores the lines times the weight: the long-wave part of z.
@group(1) @binding(0) var<storage, read> weight: array<real>;
@group(1) @binding(1) var<storage, read_write> long_waves: array<real>;

fn store_point(index: u32, on_surface: bool, line_value: real) {
    long_waves[index] = weight[index] * line_value;
}
