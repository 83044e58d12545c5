// The two coarse cells around a fine point and the share of the second one.
struct Neighbours {
    first: u32,
    second: u32,
    share: real,
}

fn neighbours(fine: u32, ratio: u32, coarse: u32) -> Neighbours {
    let cell = fine / ratio;
    let place = real(2u * (fine % ratio) + 1u) / real(2u * ratio);
    if (place < 0.5) {
        return Neighbours(select(cell - 1u, coarse - 1u, cell == 0u), cell, place + 0.5);
    }
    return Neighbours(cell, select(cell + 1u, 0u, cell + 1u == coarse), place - 0.5);
}

// A field of the coarse level, which `whole_at` reads, interpolated at a fine point.
fn long_waves_at(index: u32) -> real {
    let ratio = WIDTH / WHOLE_WIDTH;
    let x = neighbours(index % WIDTH, ratio, WHOLE_WIDTH);
    let y = neighbours(row_of(index), ratio, WHOLE_HEIGHT);
    let low = whole_at(x.first, y.first) * (1.0 - x.share) + whole_at(x.second, y.first) * x.share;
    let high = whole_at(x.first, y.second) * (1.0 - x.share) + whole_at(x.second, y.second) * x.share;
    return low * (1.0 - y.share) + high * y.share;
}
