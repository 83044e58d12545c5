// Loads the trial step, with its mean taken off in proportion to the local compliance where the
// mean gap is held.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read_write> trial_of: array<real>;

fn load_point(index: u32, on_surface: bool) -> real {
    let g = gap[index];
    let restore = real(scalars.restore);
    var s = trial_of[index];
    if (restore != 0.0) {
        s = s - restore * share_of(g + s, on_surface);
    }
    trial_of[index] = s;
    let elastic = pressure[index] + real(scalars.mean_pressure);
    let step = wide(s);
    let all = elastic + attraction(g, on_surface);
    add_sum(0u, step * wide(all));
    if (step > sums[2]) {
        sums[2] = step;
    }
    if (step < sums[3]) {
        sums[3] = step;
    }
    // On a pad a base's residual is no law's: the search will not count it.
    add_sum(5u, step * wide(select(all, elastic, on_surface)));
    return s;
}
