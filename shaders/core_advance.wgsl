// Takes K s and steps where the mean gap is held: g += t s, p += t K s.
@group(1) @binding(0) var<storage, read> trial_of: array<real>;
@group(1) @binding(1) var<storage, read_write> gap: array<real>;
@group(1) @binding(2) var<storage, read_write> pressure: array<real>;
@group(1) @binding(3) var<storage, read_write> free_before: array<real>;

fn store_point(index: u32, on_surface: bool, line_value: real) {
    let t = taken();
    let before = before_step(gap[index], pressure[index], on_surface);
    let g = gap[index] + t * trial_of[index];
    let p = pressure[index] + t * line_value;
    gap[index] = g;
    pressure[index] = p;
    free_before[index] = before;
    add_balance(g, p, on_surface);
}
