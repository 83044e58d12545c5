// Loads the trial step scaled back to the held mean gap.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read> direction: array<real>;

fn load_point(index: u32, on_surface: bool) -> real {
    let restore = real(scalars.restore);
    // A trial that no scaling brings back is lost: one that moves and does not descend.
    if (!(restore > -1.0 && restore < 1.0)) {
        sums[2] = wide(1.0);
        return 0.0;
    }
    let g = gap[index];
    let y = total(g, pressure[index], on_surface);
    let moved = real(scalars.trial) * direction[index];
    let s = trial_step(g, y, moved, restore, on_surface);
    add_trial(s, y, g, moved, on_surface);
    return s;
}
