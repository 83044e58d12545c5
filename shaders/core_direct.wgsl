// Turns the direction and finds the trial step by inverting v.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> descent: array<real>;
@group(1) @binding(2) var<storage, read_write> direction: array<real>;
@group(1) @binding(3) var<storage, read_write> trial_of: array<real>;

fn point(index: u32, on_surface: bool) {
    let g = gap[index];
    let d = real(scalars.descent) * descent[index] + real(scalars.memory) * direction[index] + real(scalars.shift);
    direction[index] = d;
    var s = real(scalars.trial) * d;
    if (on_surface && CORRECTS) {
        // A correction is short: v follows its slope.
        s = share_of(g, true) * s;
    } else if (on_surface) {
        s = gap_at(variable(g) + s, g) - g;
    }
    trial_of[index] = s;
    add_sum(0u, wide(s));
    add_sum(1u, wide(share_of(g + s, on_surface)));
}
