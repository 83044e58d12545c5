// z on free points, which are those where yF is not zero, with the long waves added from the coarse
// level.
@group(1) @binding(0) var<storage, read> free: array<real>;
@group(1) @binding(1) var<storage, read> free_before: array<real>;

fn pass_point(index: u32, on_surface: bool, line_value: real) -> real {
    let y = free[index];
    let is_free = y != 0.0;
    let z = select(0.0, line_value + long_waves_at(index), is_free);
    add_descent(z, y, free_before[index]);
    return z;
}
