// Turns the direction by the kept z and loads the trial step s.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read_write> direction: array<real>;

fn pass_point(index: u32, on_surface: bool, line_value: real) -> real {
    let g = gap[index];
    let open = open_gap(g);
    let y = total(g, pressure[index], on_surface);
    let d = new_direction(line_value, direction[index], is_free(open, y, on_surface));
    direction[index] = d;
    let moved = real(scalars.trial) * d;
    let s = trial_step(open, y, moved, 0.0, on_surface);
    add_trial(s, y, open, moved, on_surface);
    return s;
}
