// As wall_descent, where the mean gap is held.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read> free_before: array<real>;
@group(1) @binding(3) var<storage, read> direction: array<real>;

fn pass_point(index: u32, on_surface: bool, line_value: real) -> real {
    let g = gap[index];
    let y_here = total(g, pressure[index], on_surface);
    let free = is_free(open_gap(g), y_here, on_surface);
    let z = select(0.0, line_value, free);
    let y = select(0.0, y_here, free);
    add_descent_held(z, y, free_before[index], direction[index], free);
    return z;
}
