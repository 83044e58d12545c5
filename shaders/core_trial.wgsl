// Turns the direction by the kept z, finds the trial step by inverting v, and loads it.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read_write> direction: array<real>;
@group(1) @binding(3) var<storage, read_write> trial_of: array<real>;

fn pass_point(index: u32, on_surface: bool, line_value: real) -> real {
    let g = gap[index];
    let d = new_direction(line_value, direction[index]);
    direction[index] = d;
    let s = step_in_v(g, real(scalars.trial) * d, on_surface);
    trial_of[index] = s;
    add_trial(g, pressure[index], s, on_surface);
    return s;
}
