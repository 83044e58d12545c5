// Loads yF and sums the stopping measure on the way.
@group(1) @binding(0) var<storage, read> gap: array<f32>;
@group(1) @binding(1) var<storage, read> pressure: array<f32>;

fn load_point(index: u32, on_surface: bool) -> f32 {
    return free_line(gap[index], pressure[index], on_surface);
}
