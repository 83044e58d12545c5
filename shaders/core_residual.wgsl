// The stopping measure of the present state.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;

fn point(index: u32, on_surface: bool) {
    let g = gap[index];
    let traction = attraction(g, on_surface);
    add_residual(g, pressure[index] + real(scalars.mean_pressure) + traction, traction, on_surface);
}
