// Takes K s and steps, g += t s, p += t K s; then fills the rows of a transform with the new projected residual.
fn at(index: u32, in_domain: bool, line: real) -> real {
    let direction = read_direction(index);
    let way = select(direction, read_step(index), STORES_STEP);
    let moved = step_from(read_gap(index), read_pressure(index), way, line, in_domain);
    write_gap(index, moved.gap);
    write_pressure(index, moved.pressure);
    // What is stored is of the state before the step.
    let previous = select(moved.previous, read_projected_residual(index), STORED);
    write_previous_residual(index, previous);
    let here = here_at(moved.gap, moved.pressure + real(scalars.mean_pressure), in_domain);
    residual_terms(here, in_domain);
    let residual = projected_residual(here);
    into_direction_change(wide(direction) * (wide(residual) - wide(previous)));
    into_direction_residual(wide(direction) * wide(residual));
    write_projected_residual(index, residual);
    return residual;
}
