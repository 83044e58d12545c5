// Restricts the fine yF and the share of free points: the transpose of the bilinear interpolation,
// over the number of fine points in a coarse cell. `whole_at` reads the fine field.
@group(1) @binding(0) var<storage, read_write> restricted: array<real>;
@group(1) @binding(1) var<storage, read_write> share: array<real>;

// Weight of the fine point so many places from where a cell's influence begins.
fn influence(offset: u32, ratio: u32) -> real {
    return 1.0 - abs(real(2u * offset + 1u) / real(2u * ratio) - 1.0);
}

fn point(index: u32, on_surface: bool) {
    let ratio = WHOLE_WIDTH / WIDTH;
    let half = ratio / 2u;
    let first_x = index % WIDTH * ratio + WHOLE_WIDTH - half;
    let first_y = row_of(index) * ratio + WHOLE_HEIGHT - half;
    var sum: real = 0.0;
    var free: real = 0.0;
    for (var row = 0u; row < 2u * ratio; row = row + 1u) {
        let fine_row = (first_y + row) % WHOLE_HEIGHT;
        let weight = influence(row, ratio);
        let row_inside = row >= half && row < half + ratio;
        for (var column = 0u; column < 2u * ratio; column = column + 1u) {
            let value = whole_at((first_x + column) % WHOLE_WIDTH, fine_row);
            sum = sum + weight * influence(column, ratio) * value;
            if (row_inside && column >= half && column < half + ratio && value != 0.0) {
                free = free + 1.0;
            }
        }
    }
    let scale = 1.0 / real(ratio * ratio);
    restricted[index] = scale * sum;
    share[index] = scale * free;
}
