//! Roots and minima of one variable.

use super::error::TheoryError;

const MAX_STEPS: usize = 200;

/// Root of `function` between `low` and `high`, where its sign changes (Brent 1973).
///
/// Stops when the bracket is narrower than `tolerance` (or rounding). A bracket whose ends have
/// the same sign is an error naming `what`.
pub fn root(
    what: &'static str,
    mut function: impl FnMut(f64) -> f64,
    low: f64,
    high: f64,
    tolerance: f64,
) -> Result<f64, TheoryError> {
    let (mut a, mut b) = (low, high);
    let (mut fa, mut fb) = (function(a), function(b));
    if !fa.is_finite() || !fb.is_finite() || fa * fb > 0.0 {
        return Err(TheoryError::NoSolution { what });
    }
    // b is the best estimate, c lies on the other side of the root, a is the previous estimate.
    let (mut c, mut fc) = (a, fa);
    let mut step = b - a;
    let mut step_before = step;
    for _ in 0..MAX_STEPS {
        if fc.abs() < fb.abs() {
            (a, b, c) = (b, c, b);
            (fa, fb, fc) = (fb, fc, fb);
        }
        let accuracy = 2.0 * f64::EPSILON * b.abs() + 0.5 * tolerance;
        let middle = 0.5 * (c - b);
        if middle.abs() <= accuracy || fb == 0.0 {
            return Ok(b);
        }
        if step_before.abs() < accuracy || fa.abs() <= fb.abs() {
            step = middle;
            step_before = middle;
        } else {
            let s = fb / fa;
            let (mut p, mut q) = if a == c {
                (2.0 * middle * s, 1.0 - s)
            } else {
                let (q, r) = (fa / fc, fb / fc);
                (
                    s * (2.0 * middle * q * (q - r) - (b - a) * (r - 1.0)),
                    (q - 1.0) * (r - 1.0) * (s - 1.0),
                )
            };
            if p > 0.0 {
                q = -q;
            } else {
                p = -p;
            }
            if 2.0 * p < (3.0 * middle * q - (accuracy * q).abs()).min((step_before * q).abs()) {
                step_before = step;
                step = p / q;
            } else {
                step = middle;
                step_before = middle;
            }
        }
        (a, fa) = (b, fb);
        b += if step.abs() > accuracy {
            step
        } else {
            accuracy.copysign(middle)
        };
        fb = function(b);
        if fb * fc > 0.0 {
            (c, fc) = (a, fa);
            step = b - a;
            step_before = step;
        }
    }
    Err(TheoryError::NotConverged { what })
}

/// Root of an increasing or decreasing `function` of a positive variable, of any size.
///
/// Searches outwards from `guess` by factors of 2, then in the logarithm to full precision.
pub fn positive_root(
    what: &'static str,
    mut function: impl FnMut(f64) -> f64,
    guess: f64,
) -> Result<f64, TheoryError> {
    let (mut low, mut high) = (guess, guess);
    let (mut at_low, mut at_high) = (function(guess), function(guess));
    let mut factor = 2.0;
    // The factor grows too: some 80 rounds reach both ends from any number.
    while at_low * at_high > 0.0 && low > 1e-250 && high < 1e250 {
        low /= factor;
        high *= factor;
        (at_low, at_high) = (function(low), function(high));
        factor *= 1.5;
    }
    root(what, |s| function(s.exp()), low.ln(), high.ln(), 1e-15).map(f64::exp)
}

/// Position and value of the minimum of `function` between `low` and `high` (Brent 1973).
///
/// The value is accurate to rounding, its position only to the square root of that. With several
/// minima in the bracket any of them may be returned.
pub fn minimum(mut function: impl FnMut(f64) -> f64, low: f64, high: f64) -> (f64, f64) {
    let golden = 0.5 * (3.0 - 5.0_f64.sqrt());
    let (mut low, mut high) = (low, high);
    let mut x = low + golden * (high - low);
    let (mut w, mut v) = (x, x);
    let mut fx = function(x);
    let (mut fw, mut fv) = (fx, fx);
    let (mut step, mut step_before) = (0.0_f64, 0.0_f64);
    for _ in 0..MAX_STEPS {
        let middle = 0.5 * (low + high);
        let accuracy = 1e-9 * x.abs() + 1e-15 * (high - low).abs() + f64::MIN_POSITIVE;
        if (x - middle).abs() <= 2.0 * accuracy - 0.5 * (high - low) {
            break;
        }
        let mut parabola = false;
        if step_before.abs() > accuracy {
            let r = (x - w) * (fx - fv);
            let mut q = (x - v) * (fx - fw);
            let mut p = (x - v) * q - (x - w) * r;
            q = 2.0 * (q - r);
            if q > 0.0 {
                p = -p;
            }
            q = q.abs();
            let bound = step_before;
            step_before = step;
            if p.abs() < (0.5 * q * bound).abs() && p > q * (low - x) && p < q * (high - x) {
                step = p / q;
                parabola = true;
                let next = x + step;
                if next - low < 2.0 * accuracy || high - next < 2.0 * accuracy {
                    step = accuracy.copysign(middle - x);
                }
            }
        }
        if !parabola {
            step_before = if x >= middle { low - x } else { high - x };
            step = golden * step_before;
        }
        let next = if step.abs() >= accuracy {
            x + step
        } else {
            x + accuracy.copysign(step)
        };
        let value = function(next);
        if value <= fx {
            if next >= x {
                low = x;
            } else {
                high = x;
            }
            (v, w, x) = (w, x, next);
            (fv, fw, fx) = (fw, fx, value);
        } else {
            if next < x {
                low = next;
            } else {
                high = next;
            }
            if value <= fw || w == x {
                (v, w) = (w, next);
                (fv, fw) = (fw, value);
            } else if value <= fv || v == x || v == w {
                (v, fv) = (next, value);
            }
        }
    }
    (x, fx)
}

/// As [`minimum`] around the least of the values at the inner points of `parts` even parts.
pub fn scanned_minimum(
    function: impl Fn(f64) -> f64,
    low: f64,
    high: f64,
    parts: usize,
) -> (f64, f64) {
    let place = |i: usize| low + (high - low) * i as f64 / parts as f64;
    let mut best = (1, f64::INFINITY);
    for i in 1..parts {
        let value = function(place(i));
        if value < best.1 {
            best = (i, value);
        }
    }
    minimum(function, place(best.0 - 1), place(best.0 + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_found_to_rounding() {
        let x = root("x", |x| x.cos() - x, 0.0, 1.0, 1e-16).unwrap();
        assert!((x.cos() - x).abs() < 1e-15);
        let tiny = positive_root("x", |x| x * x - 1e-80, 1.0).unwrap();
        assert!((tiny / 1e-40 - 1.0).abs() < 1e-12);
        assert!(root("x", |x| x * x + 1.0, -1.0, 1.0, 1e-12).is_err());
    }

    #[test]
    fn minimum_of_a_quartic() {
        let (x, value) = minimum(|x| (x - 2.0).powi(2) * (x + 5.0).powi(2) - 3.0, 0.0, 10.0);
        assert!((x - 2.0).abs() < 1e-7 && (value + 3.0).abs() < 1e-13);
    }
}
