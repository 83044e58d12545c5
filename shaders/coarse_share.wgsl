// Loads the share of free points.
@group(1) @binding(0) var<storage, read> share: array<f32>;

fn load_point(index: u32, on_surface: bool) -> f32 {
    return share[index];
}
