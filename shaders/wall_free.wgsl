// Loads yF and sums the stopping measure on the way.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;

fn load_point(index: u32, on_surface: bool) -> real {
    return free_line(gap[index], pressure[index], on_surface);
}
