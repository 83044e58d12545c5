// Loads g + h less the offset.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> heights: array<real>;

fn load_point(index: u32, on_surface: bool) -> real {
    return (gap[index] - real(scalars.offset)) + heights[index];
}
