// Takes K s and steps: g += t s, p += t K s.
@group(1) @binding(0) var<storage, read> direction: array<f32>;
@group(1) @binding(1) var<storage, read_write> gap: array<f32>;
@group(1) @binding(2) var<storage, read_write> pressure: array<f32>;

fn store_point(index: u32, on_surface: bool, line_value: f32) {
    let g = gap[index];
    let t = f32(scalars.step);
    let open = open_gap(g);
    let s = trial_step(open, 0.0, f32(scalars.trial) * direction[index], f32(scalars.restore), on_surface);
    // By what is left of the gap, which a cut makes exactly zero.
    let left = open + t * s;
    let closed = on_surface && (left <= 0.0 || (s < 0.0 && left < f32(scalars.snap)));
    gap[index] = select(g + t * s, closed_at(), closed);
    pressure[index] = pressure[index] + t * line_value;
}
