// The two coarse cells around a fine point and the share of the second one.
struct Neighbours {
    first: u32,
    second: u32,
    share: f32,
}

fn neighbours(fine: u32, ratio: u32, coarse: u32) -> Neighbours {
    let cell = fine / ratio;
    let place = f32(2u * (fine % ratio) + 1u) / f32(2u * ratio);
    if (place < 0.5) {
        return Neighbours(select(cell - 1u, coarse - 1u, cell == 0u), cell, place + 0.5);
    }
    return Neighbours(cell, select(cell + 1u, 0u, cell + 1u == coarse), place - 0.5);
}
