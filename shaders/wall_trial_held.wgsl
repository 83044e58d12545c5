// Loads the trial step scaled back to the held mean gap.
@group(1) @binding(0) var<storage, read> gap: array<f32>;
@group(1) @binding(1) var<storage, read> pressure: array<f32>;
@group(1) @binding(2) var<storage, read> direction: array<f32>;

fn load_point(index: u32, on_surface: bool) -> f32 {
    let g = gap[index];
    let y = total(g, pressure[index], on_surface);
    let open = open_gap(g);
    let moved = f32(scalars.trial) * direction[index];
    let s = trial_step(open, y, moved, f32(scalars.restore), on_surface);
    add_trial(s, y, open, moved, on_surface);
    return s;
}
