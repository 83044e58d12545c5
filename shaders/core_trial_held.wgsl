// Loads the trial step, with its mean taken off in proportion to the local compliance.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read_write> trial_of: array<real>;

fn load_point(index: u32, on_surface: bool) -> real {
    let g = gap[index];
    let whole = trial_of[index];
    let s = whole - real(scalars.restore) * share_of(g + whole, on_surface);
    trial_of[index] = s;
    add_trial(g, pressure[index], s, on_surface);
    return s;
}
