// The stiffness itself.
fn factor_of(column: u32, row: u32) -> real {
    if (column + row == 0u) {
        return factors[0];
    }
    return wave_stiffness(column, row);
}
