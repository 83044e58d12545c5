// exp in double precision, of additions and multiplications alone: what devices have for it is made for
// single precision, and gives anything in double.

// ln 2 in two parts. The first has 21 trailing zeros, so that its product with an exponent is exact.
const LN_2_HIGH: f64 = 6.93147180369123816490e-01;
const LN_2_LOW: f64 = 1.90821492927058770002e-10;
const LOG_2_E: f64 = 1.44269504088896338700;
// Below, the result has no normal number; above, none at all.
const EXP_LEAST: f64 = -698.0;
const EXP_MOST: f64 = 709.0;

// exp(x) - 1 for |x| <= 1/2: fifteen terms of its series, the next one below 2e-18 of the result.
fn exp_series(x: f64) -> f64 {
    var sum: f64 = 1.0 / 1307674368000.0;
    sum = 1.0 / 87178291200.0 + x * sum;
    sum = 1.0 / 6227020800.0 + x * sum;
    sum = 1.0 / 479001600.0 + x * sum;
    sum = 1.0 / 39916800.0 + x * sum;
    sum = 1.0 / 3628800.0 + x * sum;
    sum = 1.0 / 362880.0 + x * sum;
    sum = 1.0 / 40320.0 + x * sum;
    sum = 1.0 / 5040.0 + x * sum;
    sum = 1.0 / 720.0 + x * sum;
    sum = 1.0 / 120.0 + x * sum;
    sum = 1.0 / 24.0 + x * sum;
    sum = 1.0 / 6.0 + x * sum;
    sum = 0.5 + x * sum;
    return x + x * (x * sum);
}

// 2 to a power that single precision has as a normal number.
fn small_power_of_two(power: i32) -> f64 {
    return f64(bitcast<f32>(u32(power + 127) << 23u));
}

// 2 to a power from -1008 to 1023: the eighth of it in single precision, eight times.
fn power_of_two(power: i32) -> f64 {
    let eighth = small_power_of_two(power >> 3u);
    let quarter = eighth * eighth;
    let half = quarter * quarter;
    return half * half * small_power_of_two(power & 7);
}

fn exponential(x: f64) -> f64 {
    if (x < EXP_LEAST) {
        return 0.0;
    }
    if (x > EXP_MOST) {
        return params.infinity;
    }
    // x = power ln 2 + rest with |rest| <= ln(2)/2.
    let power = floor(x * LOG_2_E + 0.5);
    // The least of it and infinity is what it was, and keeps a compiler from subtracting both parts as one.
    let near = min(x - power * LN_2_HIGH, params.infinity);
    let rest = near - power * LN_2_LOW;
    return (1.0 + exp_series(rest)) * power_of_two(i32(f32(power)));
}

// exp(x) - 1 without cancellation: the series where it is short.
fn exp_less_one(x: f64) -> f64 {
    if (abs(x) > 0.5) {
        return exponential(x) - 1.0;
    }
    return exp_series(x);
}
