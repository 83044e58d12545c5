// Takes the smoothed share of free points, stores its square, clipped to [0, 1], as the weight, and
// loads a field times it.
@group(1) @binding(0) var<storage, read> field: array<real>;
@group(1) @binding(1) var<storage, read_write> weight: array<real>;

fn pass_point(index: u32, on_surface: bool, line_value: real) -> real {
    let m = clamp(line_value, 0.0, 1.0);
    let here = m * m;
    weight[index] = here;
    return field[index] * here;
}
