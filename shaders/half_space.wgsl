// The stiffness of a half-space at a wavevector: the length of (column, row) in steps of the stiffness of
// the longest waves. `factors` holds the zero wavevector's factor and these two steps.
fn wave_stiffness(column: u32, row: u32) -> real {
    let x = factors[1] * real(column);
    let y = factors[2] * real(row);
    return sqrt(x * x + y * y);
}
