// Takes K s and steps: g += t s, p += t K s; no point crosses zero.
@group(1) @binding(0) var<storage, read> direction: array<real>;
@group(1) @binding(1) var<storage, read_write> gap: array<real>;
@group(1) @binding(2) var<storage, read_write> pressure: array<real>;

fn store_point(index: u32, on_surface: bool, line_value: real) {
    let g = gap[index];
    let t = real(scalars.step);
    let y = total(g, pressure[index], on_surface);
    let way = real(scalars.trial) * direction[index];
    let s = trial_step(g, y, way, real(scalars.restore), on_surface);
    var moved = g + t * s;
    if (on_surface) {
        let snap = real(scalars.snap);
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
