// What the levels answer a point with: z of the first coarser one interpolated, and the finest level's answer to the
// residual there and at its four neighbours. Twins: kernel/multilevel.rs.
fn finest_answer(index: u32) -> real {
    let x = index % WIDTH;
    let y = row_of(index);
    let before = vec2<u32>(select(x - 1u, WIDTH - 1u, x == 0u), select(y - 1u, HEIGHT - 1u, y == 0u));
    let after = vec2<u32>(select(x + 1u, 0u, x + 1u == WIDTH), select(y + 1u, 0u, y + 1u == HEIGHT));
    let own = real(params.own_compliance) * around_at(x, y);
    let beside = around_at(x, before.y) + around_at(x, after.y) + (around_at(before.x, y) + around_at(after.x, y));
    return add_interpolated(index, own + real(params.neighbour_compliance) * beside);
}
