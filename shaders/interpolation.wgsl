// Interpolation between a level and the next coarser one. Twins: kernel/multilevel.rs.

// Share of the neighbouring cell in the value at a place of a cell of `ratio` points.
fn neighbour_share(place: u32, ratio: u32) -> real {
    return abs(real(2u * place + 1u) / real(2u * ratio) - 0.5);
}

// The cell before or after `cell` on a ring, for a place in the first or second half of `cell`.
fn neighbour(cell: u32, place: u32, ratio: u32, cells: u32) -> u32 {
    if (place < ratio / 2u) {
        return select(cell - 1u, cells - 1u, cell == 0u);
    }
    return select(cell + 1u, 0u, cell + 1u == cells);
}
