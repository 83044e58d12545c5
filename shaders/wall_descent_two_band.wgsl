// As wall_descent, with the long waves added from the coarse level, which `whole_at` reads.
fn store_point(index: u32, on_surface: bool, line_value: real) {
    let ratio = WIDTH / WHOLE_WIDTH;
    let x = neighbours(index % WIDTH, ratio, WHOLE_WIDTH);
    let y = neighbours(row_of(index), ratio, WHOLE_HEIGHT);
    let low = whole_at(x.first, y.first) * (1.0 - x.share) + whole_at(x.second, y.first) * x.share;
    let high = whole_at(x.first, y.second) * (1.0 - x.share) + whole_at(x.second, y.second) * x.share;
    descend(index, on_surface, line_value + (low * (1.0 - y.share) + high * y.share));
}
