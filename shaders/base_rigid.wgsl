// Minus the pressure that the base's gap makes.
@group(1) @binding(0) var<storage, read> heights_pressure: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read_write> rigid: array<real>;

fn point(index: u32, on_surface: bool) {
    rigid[index] = heights_pressure[index] - pressure[index];
}
