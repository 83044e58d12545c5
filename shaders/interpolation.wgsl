// Interpolation between a level and the next coarser one. Twins: kernel/multilevel.rs.

// Share of the neighbouring cell in the value at a place of a cell of `ratio` points.
fn neighbour_share(place: u32, ratio: u32) -> real {
    return abs(real(2u * place + 1u) / real(2u * ratio) - 0.5);
}

// The place before one on a ring.
fn before(place: u32, places: u32) -> u32 {
    return select(place - 1u, places - 1u, place == 0u);
}

// The place after one on a ring.
fn after(place: u32, places: u32) -> u32 {
    return select(place + 1u, 0u, place + 1u == places);
}

// The cell before or after `cell` on a ring, for a place in the first or second half of `cell`.
fn neighbour(cell: u32, place: u32, ratio: u32, cells: u32) -> u32 {
    if (place < ratio / 2u) {
        return before(cell, cells);
    }
    return after(cell, cells);
}
