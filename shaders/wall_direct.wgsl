// Turns the direction and sums the trial step and the gap (fixed mean gap).
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read> descent: array<real>;
@group(1) @binding(3) var<storage, read_write> direction: array<real>;

fn point(index: u32, on_surface: bool) {
    let g = gap[index];
    let open = open_gap(g);
    let y = total(g, pressure[index], on_surface);
    let d = new_direction(descent[index], direction[index], is_free(open, y, on_surface));
    direction[index] = d;
    add_sum(0u, wide(max(real(scalars.trial) * d, -open)));
    add_sum(1u, wide(open));
}
