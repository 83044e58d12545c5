// Takes K s and steps: g += t s, p += t K s.
@group(1) @binding(0) var<storage, read> trial_of: array<f32>;
@group(1) @binding(1) var<storage, read_write> gap: array<f32>;
@group(1) @binding(2) var<storage, read_write> pressure: array<f32>;

fn store_point(index: u32, on_surface: bool, line_value: f32) {
    let t = f32(scalars.step);
    gap[index] = gap[index] + t * trial_of[index];
    pressure[index] = pressure[index] + t * line_value;
}
