// A sum while it is added up, and what of it passes between threads: a number and what rounding took from it,
// where the device has single precision alone.
alias part = vec2<f32>;

// The same number, which no compiler knows to be: `params.zero` is zero. Without it the error terms
// below are simplified away.
fn opaque(value: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(value) ^ params.zero);
}

// A sum and its rounding error (Knuth 1969, 4.2.2).
fn two_sum(a: f32, b: f32) -> vec2<f32> {
    let sum = opaque(a + b);
    let second = opaque(sum - a);
    let first = opaque(sum - second);
    return vec2<f32>(sum, opaque(opaque(a - first) + opaque(b - second)));
}

fn part_of(value: wide) -> part {
    return vec2<f32>(value, 0.0);
}

fn add(sum: part, term: wide) -> part {
    let added = two_sum(sum.x, term);
    return vec2<f32>(added.x, sum.y + added.y);
}

fn least(sum: part, term: wide) -> part {
    return vec2<f32>(select(sum.x, term, term < sum.x), sum.y);
}

fn most(sum: part, term: wide) -> part {
    return vec2<f32>(select(sum.x, term, term > sum.x), sum.y);
}

// What of it is compared.
fn leading(value: part) -> f32 {
    return value.x;
}

fn part_value(value: part) -> f32 {
    // Beyond the largest number the error is none.
    return select(value.x + value.y, value.x, !is_finite(value.x));
}

fn join_add(a: part, b: part) -> part {
    let added = two_sum(a.x, b.x);
    return vec2<f32>(added.x, added.y + (a.y + b.y));
}
