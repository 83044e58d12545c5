// y of the base of corrections; without a law on the pad.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read_write> residual: array<real>;

fn point(index: u32, on_surface: bool) {
    residual[index] = pressure[index] + real(scalars.mean_pressure) + attraction(gap[index], on_surface);
}
