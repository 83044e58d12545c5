//! Numerical integration: adaptive Gauss-Kronrod for single integrals, Gauss-Legendre for tables.

use super::error::TheoryError;
use std::f64::consts::PI;

/// Positive nodes of the 15-point Kronrod rule, largest first; the last is the centre.
const KRONROD_NODES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
    0.0,
];

const KRONROD_WEIGHTS: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_82,
];

/// Weights of the 7-point Gauss rule at Kronrod nodes 1, 3, 5, 7.
const GAUSS_WEIGHTS: [f64; 4] = [
    0.129_484_966_168_869_7,
    0.279_705_391_489_276_7,
    0.381_830_050_505_118_9,
    0.417_959_183_673_469_4,
];

const MAX_PANELS: usize = 4000;

struct Panel {
    from: f64,
    to: f64,
    value: f64,
    error: f64,
}

fn panel(integrand: &mut impl FnMut(f64) -> f64, from: f64, to: f64) -> Panel {
    let (centre, half) = (0.5 * (from + to), 0.5 * (to - from));
    let middle = integrand(centre);
    let mut kronrod = KRONROD_WEIGHTS[7] * middle;
    let mut gauss = GAUSS_WEIGHTS[3] * middle;
    let mut absolute = KRONROD_WEIGHTS[7] * middle.abs();
    for i in 0..7 {
        let left = integrand(centre - half * KRONROD_NODES[i]);
        let right = integrand(centre + half * KRONROD_NODES[i]);
        kronrod += KRONROD_WEIGHTS[i] * (left + right);
        absolute += KRONROD_WEIGHTS[i] * (left.abs() + right.abs());
        if i % 2 == 1 {
            gauss += GAUSS_WEIGHTS[i / 2] * (left + right);
        }
    }
    // A difference below rounding does not indicate an error, and splitting would not reduce it.
    let difference = ((kronrod - gauss) * half).abs();
    let rounding = 50.0 * f64::EPSILON * absolute * half.abs();
    Panel {
        from,
        to,
        value: kronrod * half,
        error: if difference <= rounding {
            0.0
        } else {
            difference
        },
    }
}

/// Integral of `integrand` from `from` to `to`, to a relative (or absolute) tolerance.
///
/// The panel with the largest error is halved until the sum of errors is below `max(absolute,
/// relative * |integral|)`. The error of a panel is the difference between its 15-point and 7-point
/// rule, which far exceeds the true one: `relative = 1e-10` gives nearly full precision for a
/// smooth integrand. End points are never evaluated.
///
/// # Source
/// Piessens et al. 1983, QUADPACK (routine QAG, rule 1).
pub fn integrate(
    mut integrand: impl FnMut(f64) -> f64,
    from: f64,
    to: f64,
    relative: f64,
    absolute: f64,
) -> Result<f64, TheoryError> {
    let mut panels = vec![panel(&mut integrand, from, to)];
    loop {
        let value: f64 = panels.iter().map(|p| p.value).sum();
        let error: f64 = panels.iter().map(|p| p.error).sum();
        if value.is_finite() && error <= absolute.max(relative * value.abs()) {
            return Ok(value);
        }
        let worst = panels
            .iter()
            .enumerate()
            .max_by(|a, b| a.1.error.total_cmp(&b.1.error))
            .map_or(0, |(i, _)| i);
        let Panel { from, to, .. } = panels.swap_remove(worst);
        let middle = 0.5 * (from + to);
        if panels.len() >= MAX_PANELS || !value.is_finite() || middle == from || middle == to {
            return Err(TheoryError::NotConverged {
                what: "the adaptive integral",
            });
        }
        panels.push(panel(&mut integrand, from, middle));
        panels.push(panel(&mut integrand, middle, to));
    }
}

/// Integral from `from` to infinity, by `x = from + scale t / (1 - t)`.
///
/// `scale` is the position of the integrand's weight; a poor choice costs panels, not digits.
pub fn integrate_to_infinity(
    mut integrand: impl FnMut(f64) -> f64,
    from: f64,
    scale: f64,
    relative: f64,
    absolute: f64,
) -> Result<f64, TheoryError> {
    let mapped = |t: f64| {
        let rest = 1.0 - t;
        let value = integrand(from + scale * t / rest);
        // The Jacobian may overflow where the integrand is already zero.
        if value == 0.0 {
            0.0
        } else {
            value * scale / (rest * rest)
        }
    };
    integrate(mapped, 0.0, 1.0, relative, absolute)
}

/// Nodes and weights of the `points`-point Gauss-Legendre rule on [-1, 1], nodes ascending.
///
/// Newton's method on the recurrence of the Legendre polynomials, from Tricomi's estimate.
pub fn gauss_legendre(points: usize) -> (Vec<f64>, Vec<f64>) {
    let mut nodes = vec![0.0; points];
    let mut weights = vec![0.0; points];
    for i in 0..points.div_ceil(2) {
        let mut x = (PI * (i as f64 + 0.75) / (points as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (mut before, mut now) = (0.0, 1.0);
            for k in 0..points {
                let k = k as f64;
                (before, now) = (now, ((2.0 * k + 1.0) * x * now - k * before) / (k + 1.0));
            }
            slope = points as f64 * (x * now - before) / (x * x - 1.0);
            let step = now / slope;
            x -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
        let weight = 2.0 / ((1.0 - x * x) * slope * slope);
        (nodes[i], nodes[points - 1 - i]) = (-x, x);
        (weights[i], weights[points - 1 - i]) = (weight, weight);
    }
    (nodes, weights)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn adaptive_rule_finds_a_peak_and_an_end_singularity() {
        let peak = integrate(|x| 1.0 / (1e-6 + x * x), -1.0, 1.0, 1e-11, 0.0).unwrap();
        assert!((peak / (2e3 * (1e3_f64).atan()) - 1.0).abs() < 1e-11);
        let root = integrate(|x: f64| x.sqrt(), 0.0, 1.0, 1e-12, 0.0).unwrap();
        assert!((root - 2.0 / 3.0).abs() < 1e-12);
        let tail = integrate_to_infinity(|x| (-x).exp(), 2.0, 1.0, 1e-12, 0.0).unwrap();
        assert!((tail / (-2.0_f64).exp() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn divergent_integral_is_an_error() {
        assert!(integrate(|x| 1.0 / x, 0.0, 1.0, 1e-8, 0.0).is_err());
    }

    #[test]
    fn gauss_legendre_is_exact_to_degree_2n_minus_1() {
        for points in [1, 2, 5, 8, 20] {
            let (nodes, weights) = gauss_legendre(points);
            let degree = 2 * points as i32 - 2;
            let sum: f64 = nodes
                .iter()
                .zip(&weights)
                .map(|(x, w)| w * x.powi(degree))
                .sum();
            assert!((sum - 2.0 / (degree as f64 + 1.0)).abs() < 1e-14);
        }
    }
}
