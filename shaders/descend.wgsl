// The sums from which the direction's conjugacy is found.
fn add_descent(z: real, y: real, y_before: real) {
    add_sum(0u, wide(z) * wide(y));
    add_sum(1u, wide(z) * (wide(y) - wide(y_before)));
}

// Those that the direction enters too, and what takes the means off (fixed mean gap).
fn add_descent_held(z: real, y: real, y_before: real, direction_here: real, free_here: bool) {
    add_descent(z, y, y_before);
    let d = wide(direction_here);
    let change = wide(y) - wide(y_before);
    add_sum(2u, d * change);
    if (free_here) {
        add_sum(3u, d * wide(y));
        add_sum(4u, wide(z));
        add_sum(5u, wide(1.0));
        add_sum(6u, wide(y));
        add_sum(7u, change);
        add_sum(8u, d);
    }
}
