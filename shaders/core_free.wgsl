// Loads S2 y and sums the stopping measure on the way.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;

fn load_point(index: u32, on_surface: bool) -> real {
    let g = gap[index];
    let traction = attraction(g, on_surface);
    let y = pressure[index] + real(scalars.mean_pressure) + traction;
    add_residual(g, y, traction, on_surface);
    return share_of(g, on_surface) * y;
}
