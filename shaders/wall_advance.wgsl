// Takes K s and steps: g += t s, p += t K s.
@group(1) @binding(0) var<storage, read> direction: array<real>;
@group(1) @binding(1) var<storage, read_write> gap: array<real>;
@group(1) @binding(2) var<storage, read_write> pressure: array<real>;

fn store_point(index: u32, on_surface: bool, line_value: real) {
    let g = gap[index];
    let t = real(scalars.step);
    let open = open_gap(g);
    let s = trial_step(open, 0.0, real(scalars.trial) * direction[index], real(scalars.restore), on_surface);
    // By what is left of the gap, which a cut makes exactly zero.
    let left = open + t * s;
    let closed = on_surface && (left <= 0.0 || (s < 0.0 && left < real(scalars.snap)));
    gap[index] = select(g + t * s, closed_at(), closed);
    pressure[index] = pressure[index] + t * line_value;
}
