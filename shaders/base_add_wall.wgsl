// Adds a correction found in single precision to the base, over a wall.
@group(1) @binding(0) var<storage, read> correction: array<real>;
@group(1) @binding(1) var<storage, read_write> gap: array<real>;

fn point(index: u32, on_surface: bool) {
    let c = correction[index];
    var g = gap[index];
    // A correction closes the points where it undoes the base as single precision has it.
    let undone = -real(f32(g));
    g = g + c;
    if (on_surface && (c <= undone || g < 0.0)) {
        g = 0.0;
    }
    gap[index] = g;
    add_sum(0u, wide(g) - scalars.offset);
    add_sum(1u, wide(g));
}
