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
