// The decisions over a wall's trial step where the mean gap is held, by linearity.

// Roundings of what they are taken from within which the parts of s cancel each other.
const VANISHES: wide = 8.0;

// The share of a trial gap that brings it back to the held mean, and in place of the sums over s0 those over s.
fn restore_wall() {
    if (waits()) {
        return;
    }
    let open = scalars.sums[6];
    let trial = open + scalars.sums[5];
    var restore = ZERO;
    if (trial > ZERO) {
        restore = -scalars.sums[5] / trial;
    }
    let whole = ONE + restore;
    scalars.restore = restore;
    scalars.sums[0] = whole * scalars.sums[0] + restore * scalars.sums[7];
    // A point that was cut touches at the step 1 exactly.
    let closing = scalars.sums[1];
    var most = ONE;
    if (closing < ONE) {
        most = whole * closing - restore;
    }
    scalars.sums[1] = params.infinity;
    if (open > ZERO && most > ZERO) {
        scalars.sums[1] = ONE / most;
    }
    if (open > ZERO && trial <= ZERO) {
        // Nothing is left of the gap that could be scaled back.
        scalars.sums[0] = ZERO;
    }
    if (open > ZERO && most <= VANISHES * params.epsilon * (abs(closing) + abs(restore))) {
        // The step vanishes but for its rounding.
        scalars.sums[0] = ZERO;
        scalars.sums[1] = params.infinity;
        scalars.sums[2] = ZERO;
        scalars.sums[3] = ZERO;
        return;
    }
    scalars.sums[2] = whole * scalars.sums[2];
    scalars.sums[3] = whole * scalars.sums[3];
}

// <s, K s> from <s0, K s0>, which the convolution has handed in.
fn curve_wall() {
    if (waits() || scalars.accepted == 0u) {
        return;
    }
    let restore = scalars.restore;
    let whole = ONE + restore;
    let step = whole * whole * scalars.curvature;
    let mixed = wide(2.0) * whole * restore * scalars.sums[8];
    let own = restore * restore * scalars.sums[9];
    scalars.curvature = step + mixed + own;
    // Where K g has no digits left its sums must not be taken for a motion without curvature.
    let least = params.epsilon * (step + abs(mixed) + abs(own));
    if (scalars.curvature < least) {
        scalars.curvature = least;
    }
}
