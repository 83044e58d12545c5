// Turns the direction by the kept z and loads the trial step s0, with all sums from which that of the held mean
// gap follows.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read> heights_pressure: array<real>;
@group(1) @binding(3) var<storage, read_write> direction: array<real>;

fn pass_point(index: u32, on_surface: bool, line_value: real) -> real {
    let g = gap[index];
    let p = pressure[index];
    let open = open_gap(g);
    let y = total(g, p, on_surface);
    let d = new_direction(line_value, direction[index], is_free(open, y, on_surface));
    direction[index] = d;
    let moved = real(scalars.trial) * d;
    let s = trial_step(open, y, moved, 0.0, on_surface);
    let step = wide(s);
    add_sum(0u, step * wide(y));
    if (open > 0.0) {
        let closing = wide(-s / open);
        if (closing > sums[1]) {
            sums[1] = closing;
        }
    }
    if (step > sums[2]) {
        sums[2] = step;
    }
    if (step < sums[3]) {
        sums[3] = step;
    }
    if (on_surface && open + moved < 0.0) {
        sums[4] = wide(1.0);
    }
    let bent = wide(p - heights_pressure[index]);
    add_sum(5u, step);
    add_sum(6u, wide(open));
    add_sum(7u, wide(open) * wide(y));
    add_sum(8u, step * bent);
    add_sum(9u, wide(open) * bent);
    return s;
}
