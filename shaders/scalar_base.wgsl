// The decision that belongs to the base of corrections.

// The share of each point's weight that brings the mean gap back; 0 where nothing has any.
fn restore_base() {
    scalars.restore = ZERO;
    if (scalars.sums[1] > ZERO) {
        scalars.restore = scalars.sums[0] / scalars.sums[1];
    }
}
