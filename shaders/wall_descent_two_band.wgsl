// As wall_descent, with the long waves added from the coarse level.
@group(1) @binding(5) var<storage, read> long_waves: array<real>;

fn store_point(index: u32, on_surface: bool, line_value: real) {
    let ratio = WIDTH / WHOLE_WIDTH;
    let x = neighbours(index % WIDTH, ratio, WHOLE_WIDTH);
    let y = neighbours(index / WIDTH, ratio, WHOLE_HEIGHT);
    let below = y.first * WHOLE_WIDTH;
    let above = y.second * WHOLE_WIDTH;
    let low = long_waves[below + x.first] * (1.0 - x.share) + long_waves[below + x.second] * x.share;
    let high = long_waves[above + x.first] * (1.0 - x.share) + long_waves[above + x.second] * x.share;
    descend(index, on_surface, line_value + (low * (1.0 - y.share) + high * y.share));
}
