// Stores the preconditioned residual z on free points and replaces the old yF by the new one.
fn store_point(index: u32, on_surface: bool, line_value: real) {
    descend(index, on_surface, line_value);
}
