//! Contact area of a rough surface by its spectrum: Persson 2001, corrected 2008.
//!
//! With `P` the nominal pressure over `E* h'_rms`, the contact area fraction does not depend on the
//! shape of the spectrum. The factor `gamma` (0.4 to 0.55 in the literature, here usually 0.5) is
//! the elastic energy of partial contact relative to that of full contact; `gamma = 1` is the first
//! version of the theory.

use super::error::{TheoryError, not_negative, positive, within};
use super::quadrature::gauss_legendre;
use super::special::{erf, exponential_integral};
use std::f64::consts::SQRT_2;

const LOG_STEP: f64 = 0.005;
const LOG_START: f64 = -4.605_170_185_988_091;
const LOG_ENTRIES: usize = 8400;
const GAP_STEP: f64 = 0.005;
const GAP_ENTRIES: usize = 1400;

/// The functions of the theory that depend only on `gamma`, tabulated once (some milliseconds).
#[derive(Clone, Debug)]
pub struct Persson {
    gamma: f64,
    /// log g over log v, in steps of `LOG_STEP` from v = 0.01.
    log_variance: Vec<f64>,
    /// `J(x)` in steps of `GAP_STEP` from 0.
    repulsion: Vec<f64>,
    /// `GAP_STEP` times its derivative.
    repulsion_slopes: Vec<f64>,
}

/// Contact area fraction by the first version: `erf(sqrt2 P)`. Persson 2001.
#[doc(hidden)]
pub fn original_area_fraction(reduced_pressure: f64) -> Result<f64, TheoryError> {
    Ok(erf(
        SQRT_2 * not_negative("reduced_pressure", reduced_pressure)?
    ))
}

impl Persson {
    /// The theory with a `gamma` in (0, 1].
    pub fn new(gamma: f64) -> Result<Self, TheoryError> {
        within("gamma", gamma, gamma > 0.0 && gamma <= 1.0, "in (0, 1]")?;
        let mut theory = Persson {
            gamma,
            log_variance: Vec::with_capacity(LOG_ENTRIES),
            repulsion: vec![0.0; GAP_ENTRIES],
            repulsion_slopes: (0..GAP_ENTRIES)
                .map(|i| -repulsion_rate(i as f64 * GAP_STEP) * GAP_STEP)
                .collect(),
        };
        // Up to v = 0.01 the contact is complete (the error function is 1 to all digits).
        let mut now = LOG_START;
        for i in 0..LOG_ENTRIES {
            theory.log_variance.push(now);
            let at = LOG_START + i as f64 * LOG_STEP;
            let k1 = theory.log_rate(at, now);
            let k2 = theory.log_rate(at + 0.5 * LOG_STEP, now + 0.5 * LOG_STEP * k1);
            let k3 = theory.log_rate(at + 0.5 * LOG_STEP, now + 0.5 * LOG_STEP * k2);
            let k4 = theory.log_rate(at + LOG_STEP, now + LOG_STEP * k3);
            now += LOG_STEP / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
        }
        let (nodes, weights) = gauss_legendre(8);
        for i in (0..GAP_ENTRIES - 1).rev() {
            let middle = (i as f64 + 0.5) * GAP_STEP;
            let sum: f64 = nodes
                .iter()
                .zip(&weights)
                .map(|(x, w)| w * repulsion_rate(middle + 0.5 * GAP_STEP * x))
                .sum();
            theory.repulsion[i] = theory.repulsion[i + 1] + 0.5 * GAP_STEP * sum;
        }
        Ok(theory)
    }

    /// The energy factor.
    pub fn gamma(&self) -> f64 {
        self.gamma
    }

    /// Contact area fraction at `P = pressure/(E* h'_rms)`. Persson 2008.
    ///
    /// The slope variance is scaled by `S = gamma + (1-gamma) (A/A0)^2` wave number by wave number:
    /// `dg/dv = gamma + (1-gamma) erf(sqrt(2/g))^2` from full contact at v = 0 to `v = P^-2`.
    pub fn area_fraction(&self, reduced_pressure: f64) -> Result<f64, TheoryError> {
        let pressure = not_negative("reduced_pressure", reduced_pressure)?;
        Ok(self.area_at_variance(1.0 / (pressure * pressure)))
    }

    /// Contact area fraction at the slope variance `v = V (E*/p)^2`.
    pub(crate) fn area_at_variance(&self, v: f64) -> f64 {
        if v == f64::INFINITY {
            return 0.0;
        }
        erf((2.0 / self.corrected_variance(v)).sqrt())
    }

    fn corrected_variance(&self, v: f64) -> f64 {
        let place = (v.ln() - LOG_START) / LOG_STEP;
        if place <= 0.0 {
            return v;
        }
        let last = LOG_ENTRIES - 1;
        if place >= last as f64 {
            // Nearly no contact is left: g increases by gamma v.
            let end = LOG_START + last as f64 * LOG_STEP;
            return self.log_variance[last].exp() + self.gamma * (v - end.exp());
        }
        let i = place as usize;
        let (left, right) = (self.log_variance[i], self.log_variance[i + 1]);
        let at = LOG_START + i as f64 * LOG_STEP;
        let slopes = (
            self.log_rate(at, left) * LOG_STEP,
            self.log_rate(at + LOG_STEP, right) * LOG_STEP,
        );
        hermite(place - i as f64, (left, right), slopes).exp()
    }

    /// `d log g / d log v`.
    fn log_rate(&self, log_v: f64, log_g: f64) -> f64 {
        let touching = erf((2.0 * (-log_g).exp()).sqrt());
        (log_v - log_g).exp() * (self.gamma + (1.0 - self.gamma) * touching * touching)
    }

    /// `I(x0) = int_x0^inf (gamma + 3 (1-gamma) erf(x)^2) exp(-x^2)/x dx`. Yang & Persson 2008.
    #[doc(hidden)]
    pub fn gap_integral(&self, x0: f64) -> Result<f64, TheoryError> {
        Ok(self.gap_integral_at(positive("x0", x0)?))
    }

    pub(crate) fn gap_integral_at(&self, x0: f64) -> f64 {
        let place = x0 / GAP_STEP;
        // Compare before converting to an index: a position beyond all integers has no next one.
        let repulsion = if place >= (GAP_ENTRIES - 1) as f64 {
            0.0
        } else {
            let i = place as usize;
            let slopes = (self.repulsion_slopes[i], self.repulsion_slopes[i + 1]);
            let values = (self.repulsion[i], self.repulsion[i + 1]);
            hermite(place - i as f64, values, slopes)
        };
        0.5 * self.gamma * exponential_integral(x0 * x0) + 3.0 * (1.0 - self.gamma) * repulsion
    }
}

/// `erf(x)^2 exp(-x^2)/x`.
fn repulsion_rate(x: f64) -> f64 {
    if x == 0.0 {
        return 0.0;
    }
    let touching = erf(x);
    touching * touching * (-x * x).exp() / x
}

/// Cubic through two values and two slopes at 0 and 1.
fn hermite(s: f64, values: (f64, f64), slopes: (f64, f64)) -> f64 {
    let r = 1.0 - s;
    values.0 * r * r * (1.0 + 2.0 * s)
        + values.1 * s * s * (3.0 - 2.0 * s)
        + s * r * (slopes.0 * r - slopes.1 * s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn limits_are_the_original_theory_and_the_small_load_line() {
        let original = Persson::new(1.0).unwrap();
        for pressure in [1e-3, 0.1, 1.0] {
            let first = original_area_fraction(pressure).unwrap();
            assert!((original.area_fraction(pressure).unwrap() - first).abs() < 1e-12);
        }
        let theory = Persson::new(0.45).unwrap();
        let small = theory.area_fraction(1e-6).unwrap() / 1e-6;
        let line = (8.0 / (PI * 0.45)).sqrt();
        assert!((small / line - 1.0).abs() < 1e-4);
        assert_eq!(theory.area_fraction(0.0).unwrap(), 0.0);
        assert!((theory.repulsion[0] - 0.407_124_934_6).abs() < 1e-10);
    }
}
