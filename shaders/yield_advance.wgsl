// Takes K s and steps: g += t s, p += t K s; no point crosses zero.
@group(1) @binding(0) var<storage, read> direction: array<f32>;
@group(1) @binding(1) var<storage, read_write> gap: array<f32>;
@group(1) @binding(2) var<storage, read_write> pressure: array<f32>;

fn store_point(index: u32, on_surface: bool, line_value: f32) {
    let g = gap[index];
    let t = f32(scalars.step);
    let y = total(g, pressure[index], on_surface);
    let way = f32(scalars.trial) * direction[index];
    let s = trial_step(g, y, way, f32(scalars.restore), on_surface);
    var moved = g + t * s;
    if (on_surface) {
        let snap = f32(scalars.snap);
        if (goes_down(g, y)) {
            moved = min(moved, 0.0);
            if (s > 0.0 && moved > -snap) {
                moved = 0.0;
            }
        } else {
            moved = max(moved, 0.0);
            if (s < 0.0 && moved < snap) {
                moved = 0.0;
            }
        }
    }
    gap[index] = moved;
    pressure[index] = pressure[index] + t * line_value;
}
