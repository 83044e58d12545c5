// Sums of a thread, and what of them passes between threads: a number and what rounding took from it,
// where the device has single precision alone.
alias part = vec2<f32>;

var<private> lost_sums: array<f32, SUM_COUNT>;

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

fn add_sum(slot: u32, term: f32) {
    let added = two_sum(sums[slot], term);
    sums[slot] = added.x;
    lost_sums[slot] = lost_sums[slot] + added.y;
}

fn least(slot: u32, term: wide) {
    if (term < sums[slot]) {
        sums[slot] = term;
    }
}

fn most(slot: u32, term: wide) {
    if (term > sums[slot]) {
        sums[slot] = term;
    }
}

fn part_of(slot: u32) -> part {
    return vec2<f32>(sums[slot], lost_sums[slot]);
}

fn set_part(slot: u32, value: part) {
    sums[slot] = value.x;
    lost_sums[slot] = value.y;
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
