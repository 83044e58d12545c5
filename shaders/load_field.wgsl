// Loads a field as it is.
@group(1) @binding(0) var<storage, read> field: array<f32>;

fn load_point(index: u32, on_surface: bool) -> f32 {
    return field[index];
}
