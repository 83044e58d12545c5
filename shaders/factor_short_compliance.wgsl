// The inverse of the stiffness less the share of it that long waves have: `(1 - exp(-(scale K)^2))/K`.
fn factor_of(column: u32, row: u32) -> real {
    if (column + row == 0u) {
        return factors[0];
    }
    let stiffness = wave_stiffness(column, row);
    let scaled = factors[3] * stiffness;
    return -exp_less_one(-scaled * scaled) / stiffness;
}
