// Takes K s and steps where the mean gap is held: g += t s, p += t K s.
@group(1) @binding(0) var<storage, read> direction: array<real>;
@group(1) @binding(1) var<storage, read_write> gap: array<real>;
@group(1) @binding(2) var<storage, read_write> pressure: array<real>;
@group(1) @binding(3) var<storage, read_write> free_before: array<real>;

fn store_point(index: u32, on_surface: bool, line_value: real) {
    let moved = step_from(gap[index], pressure[index], direction[index], line_value, on_surface);
    gap[index] = moved.gap;
    pressure[index] = moved.pressure;
    free_before[index] = moved.before;
    add_balance(moved.gap, moved.pressure, on_surface);
}
