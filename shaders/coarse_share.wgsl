// Loads the share of free points.
@group(1) @binding(0) var<storage, read> share: array<real>;

fn load_point(index: u32, on_surface: bool) -> real {
    return share[index];
}
