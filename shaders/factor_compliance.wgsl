// The inverse of the stiffness.
fn factor_of(column: u32, row: u32) -> real {
    if (column + row == 0u) {
        return factors[0];
    }
    return 1.0 / wave_stiffness(column, row);
}
