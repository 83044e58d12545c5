// Change of the traction along a step at each length tried.
fn changes(gap: real, step: real) {
    let s = wide(step);
    into_change_at_first(wide(change(gap, real(scalars.tried[0]) * step)) * s);
    into_change_at_second(wide(change(gap, real(scalars.tried[1]) * step)) * s);
    into_change_at_third(wide(change(gap, real(scalars.tried[2]) * step)) * s);
    into_change_at_fourth(wide(change(gap, real(scalars.tried[3]) * step)) * s);
}

// Change of traction and energy of a smooth law.
fn energies(gap: real, step: real) {
    let moved = real(scalars.step) * step;
    let energy = energy_change(gap, moved);
    into_change_at_first(wide(change(gap, moved)) * wide(step));
    into_energy_change(wide(energy.x));
    into_energy_size(wide(energy.y));
}

// What the step lengths that one pass tries change of the traction, of a smooth law of the energy.
fn at(index: u32, in_domain: bool, line: real) -> real {
    if (!in_domain) {
        return line;
    }
    let gap = read_gap(index);
    if (STORES_STEP) {
        energies(gap, read_step(index));
        return line;
    }
    // To which side a closed point may move is told by its pressure, where there are two.
    let here = here_at(gap, read_pressure(index) + real(scalars.mean_pressure), true);
    let moved = real(scalars.trial_length) * read_direction(index);
    // Below zero the pressure does not change.
    if (!goes_down(gap, here.y)) {
        changes(gap, trial_step(here, moved, real(scalars.mean_gap_correction)).step);
    }
    return line;
}
