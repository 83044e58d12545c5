// Takes K s and steps: g += t s, p += t K s.
@group(1) @binding(0) var<storage, read> trial_of: array<real>;
@group(1) @binding(1) var<storage, read_write> gap: array<real>;
@group(1) @binding(2) var<storage, read_write> pressure: array<real>;

fn store_point(index: u32, on_surface: bool, line_value: real) {
    let t = real(scalars.step);
    gap[index] = gap[index] + t * trial_of[index];
    pressure[index] = pressure[index] + t * line_value;
}
