// Loads a field times its weight.
@group(1) @binding(0) var<storage, read> field: array<real>;
@group(1) @binding(1) var<storage, read> weight: array<real>;

fn load_point(index: u32, on_surface: bool) -> real {
    return field[index] * weight[index];
}
