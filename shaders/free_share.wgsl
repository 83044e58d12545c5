// The share of free points in a cell: those where the projected residual, which `whole_at` reads, is not zero.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let ratio = WHOLE_WIDTH / WIDTH;
    let first_x = index % WIDTH * ratio;
    let first_y = row_of(index) * ratio;
    var free: real = 0.0;
    for (var row = 0u; row < ratio; row = row + 1u) {
        for (var column = 0u; column < ratio; column = column + 1u) {
            if (whole_at(first_x + column, first_y + row) != 0.0) {
                free = free + 1.0;
            }
        }
    }
    write_share(index, free / real(ratio * ratio));
    return line;
}
