// When a kernel runs: one function for each gate of the catalogue.
fn gate_always() -> bool {
    return true;
}

// The solve has ended, or its iteration waits for the end of a search.
fn waits() -> bool {
    return scalars.status != RUNNING || scalars.searching != 0u;
}

fn gate_running() -> bool {
    return !waits();
}

fn gate_fresh() -> bool {
    return !waits() && scalars.repeat == 0u;
}

fn gate_accepted() -> bool {
    return !waits() && scalars.accepted != 0u;
}

fn gate_searching() -> bool {
    return scalars.status == RUNNING && scalars.searching != 0u;
}
