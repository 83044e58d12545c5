// Stores the lines as they are.
@group(1) @binding(0) var<storage, read_write> field: array<real>;

fn store_point(index: u32, on_surface: bool, line_value: real) {
    field[index] = line_value;
}
