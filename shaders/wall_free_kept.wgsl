// As wall_free, and keeps yF in a field for the coarse level.
@group(1) @binding(0) var<storage, read> gap: array<real>;
@group(1) @binding(1) var<storage, read> pressure: array<real>;
@group(1) @binding(2) var<storage, read_write> free: array<real>;

fn load_point(index: u32, on_surface: bool) -> real {
    let y = free_line(gap[index], pressure[index], on_surface);
    free[index] = y;
    return y;
}
