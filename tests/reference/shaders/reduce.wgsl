// The least and the largest of two parts of a sum; of a number and none, none.
fn join_min(a: part, b: part) -> part {
    if (leading(b) < leading(a) || is_nan(leading(b))) {
        return b;
    }
    return a;
}

fn join_max(a: part, b: part) -> part {
    if (leading(b) > leading(a) || is_nan(leading(b))) {
        return b;
    }
    return a;
}
