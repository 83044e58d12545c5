// The factor of a wavevector out of a table, which begins at column FIRST_COLUMN of the grid.
fn factor_of(column: u32, row: u32) -> real {
    return factors[(column - first_column()) * FACTOR_ROWS + row];
}
