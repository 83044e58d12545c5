// Turns the direction and loads the trial step s.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read> descent: array<real>;
@group(1) @binding(3) var<storage, read_write> direction: array<real>;

fn load_point(index: u32, on_surface: bool) -> real {
    let g = gap[index];
    let open = open_gap(g);
    let y = total(g, pressure[index], on_surface);
    let d = new_direction(descent[index], direction[index], is_free(open, y, on_surface));
    direction[index] = d;
    let moved = real(scalars.trial) * d;
    let s = trial_step(open, y, moved, 0.0, on_surface);
    add_trial(s, y, open, moved, on_surface);
    return s;
}
