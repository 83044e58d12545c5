// Stores the lines as they are.
@group(1) @binding(0) var<storage, read_write> field: array<f32>;

fn store_point(index: u32, on_surface: bool, line_value: f32) {
    field[index] = line_value;
}
