// Takes K s and steps: g += t s, p += t K s; then loads the new yF and sums the stopping measure and what
// the step says of its direction.
@group(1) @binding(0) var<storage, read> direction: array<real>;
@group(1) @binding(1) var<storage, read_write> gap: array<real>;
@group(1) @binding(2) var<storage, read_write> pressure: array<real>;
@group(1) @binding(3) var<storage, read_write> free_before: array<real>;

fn pass_point(index: u32, on_surface: bool, line_value: real) -> real {
    let d = direction[index];
    let moved = step_from(gap[index], pressure[index], d, line_value, on_surface);
    gap[index] = moved.gap;
    pressure[index] = moved.pressure;
    free_before[index] = moved.before;
    let y = free_line(moved.gap, moved.pressure, on_surface);
    add_sum(4u, wide(d) * (wide(y) - wide(moved.before)));
    add_sum(5u, wide(d) * wide(y));
    return y;
}
