// Takes K s and steps: g += t s, p += t K s.
@group(1) @binding(0) var<storage, read> direction: array<f32>;
@group(1) @binding(1) var<storage, read_write> gap: array<f32>;
@group(1) @binding(2) var<storage, read_write> pressure: array<f32>;

fn store_point(index: u32, on_surface: bool, line_value: f32) {
    let g = gap[index];
    let t = f32(scalars.step);
    let s = trial_step(g, 0.0, f32(scalars.trial) * direction[index], f32(scalars.restore), on_surface);
    var moved = g + t * s;
    if (on_surface) {
        moved = max(moved, 0.0);
        if (s < 0.0 && moved < f32(scalars.snap)) {
            moved = 0.0;
        }
    }
    gap[index] = moved;
    pressure[index] = pressure[index] + t * line_value;
}
