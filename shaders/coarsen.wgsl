// Restricts the residual of a level: the transpose of the bilinear interpolation, over the number of finer
// points along a cell. `whole_at` reads the finer field.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let ratio = WHOLE_WIDTH / WIDTH;
    let half = ratio / 2u;
    let first_x = index % WIDTH * ratio + WHOLE_WIDTH - half;
    let first_y = row_of(index) * ratio + WHOLE_HEIGHT - half;
    var sum: real = 0.0;
    // This cell's own points, and the nearer halves of the cells around it.
    for (var row = 0u; row < 2u * ratio; row = row + 1u) {
        let fine_row = (first_y + row) % WHOLE_HEIGHT;
        let own_row = row >= half && row < half + ratio;
        let far_y = neighbour_share((row + half) % ratio, ratio);
        let weight = select(far_y, 1.0 - far_y, own_row);
        for (var column = 0u; column < 2u * ratio; column = column + 1u) {
            let value = whole_at((first_x + column) % WHOLE_WIDTH, fine_row);
            let own_column = column >= half && column < half + ratio;
            let far_x = neighbour_share((column + half) % ratio, ratio);
            sum = sum + weight * select(far_x, 1.0 - far_x, own_column) * value;
        }
    }
    write_restricted(index, sum / real(ratio));
    return line;
}
