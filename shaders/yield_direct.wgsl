// Turns the direction and sums the trial step, the gap, and the depth of the trial (fixed mean gap).
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read> descent: array<real>;
@group(1) @binding(3) var<storage, read_write> direction: array<real>;

fn point(index: u32, on_surface: bool) {
    let g = gap[index];
    let y = total(g, pressure[index], on_surface);
    let d = new_direction(descent[index], direction[index], is_free(g, y, on_surface));
    direction[index] = d;
    let moved = real(scalars.trial) * d;
    let s = select(max(moved, -g), min(moved, -g), goes_down(g, y));
    add_sum(0u, wide(s));
    add_sum(1u, wide(g));
    add_sum(2u, wide(max(-(g + s), 0.0)));
}
