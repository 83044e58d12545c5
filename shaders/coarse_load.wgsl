// Loads a field times its weight.
@group(1) @binding(0) var<storage, read> field: array<f32>;
@group(1) @binding(1) var<storage, read> weight: array<f32>;

fn load_point(index: u32, on_surface: bool) -> f32 {
    return field[index] * weight[index];
}
