// Loads g + h less the offset.
@group(1) @binding(0) var<storage, read> gap: array<f32>;
@group(1) @binding(1) var<storage, read> heights: array<f32>;

fn load_point(index: u32, on_surface: bool) -> f32 {
    return (gap[index] - f32(scalars.offset)) + heights[index];
}
