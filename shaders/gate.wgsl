// When a kernel runs: one function for each gate of the catalogue.
fn gate_always() -> bool {
    return true;
}

fn gate_running() -> bool {
    return scalars.status == RUNNING;
}

fn gate_fresh() -> bool {
    return scalars.status == RUNNING && scalars.repeat == 0u;
}

fn gate_accepted() -> bool {
    return scalars.status == RUNNING && scalars.accepted != 0u;
}

fn gate_searching() -> bool {
    return scalars.status == RUNNING && scalars.searching != 0u;
}
