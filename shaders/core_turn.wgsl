// Takes K s and steps: g += t s, p += t K s; then loads the new S2 y and sums the stopping measure and
// what the step says of its direction.
@group(1) @binding(0) var<storage, read> direction: array<real>;
@group(1) @binding(1) var<storage, read> trial_of: array<real>;
@group(1) @binding(2) var<storage, read_write> gap: array<real>;
@group(1) @binding(3) var<storage, read_write> pressure: array<real>;
@group(1) @binding(4) var<storage, read_write> free_before: array<real>;

fn pass_point(index: u32, on_surface: bool, line_value: real) -> real {
    let t = taken();
    let before = before_step(gap[index], pressure[index], on_surface);
    let g = gap[index] + t * trial_of[index];
    let p = pressure[index] + t * line_value;
    gap[index] = g;
    pressure[index] = p;
    free_before[index] = before;
    let y = free_line(g, p, on_surface);
    let d = wide(direction[index]);
    add_sum(4u, d * (wide(y) - wide(before)));
    add_sum(5u, d * wide(y));
    return y;
}
