// Loads a field as it is.
@group(1) @binding(0) var<storage, read> field: array<real>;

fn load_point(index: u32, on_surface: bool) -> real {
    return field[index];
}
