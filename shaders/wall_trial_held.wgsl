// Loads the trial step scaled back to the held mean gap.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read> direction: array<real>;

fn load_point(index: u32, on_surface: bool) -> real {
    let g = gap[index];
    let y = total(g, pressure[index], on_surface);
    let open = open_gap(g);
    let moved = real(scalars.trial) * direction[index];
    let s = trial_step(open, y, moved, real(scalars.restore), on_surface);
    add_trial(s, y, open, moved, on_surface);
    return s;
}
