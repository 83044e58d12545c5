// As two_band_descent, where the mean gap is held.
@group(1) @binding(0) var<storage, read> free: array<real>;
@group(1) @binding(1) var<storage, read> free_before: array<real>;
@group(1) @binding(2) var<storage, read> direction: array<real>;

fn pass_point(index: u32, on_surface: bool, line_value: real) -> real {
    let y = free[index];
    let is_free = y != 0.0;
    let z = select(0.0, line_value + long_waves_at(index), is_free);
    add_descent_held(z, y, free_before[index], direction[index], is_free);
    return z;
}
