//! Self-affine spectrum with a roll-off plateau, and its roughness parameters.
//!
//! `C(q)`, m^4, is isotropic with `<h^2> = 2 pi int q C dq`: constant from the smallest wave number
//! qL to the roll-off q0, then `C0 (q/q0)^(-2(H+1))` up to the largest, q1.
//! Longuet-Higgins 1957, Nayak 1971, McCool 1986.

use super::error::{TheoryError, positive, within};
use std::f64::consts::PI;

/// A self-affine spectrum. Lengths in m, wave numbers in 1/m; any other unit of length works if
/// used throughout.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum {
    smallest: f64,
    rolloff: f64,
    largest: f64,
    hurst_exponent: f64,
    plateau: f64,
}

impl Spectrum {
    /// A spectrum between `wavenumbers = [qL, q0, q1]` (1/m, `qL <= q0 < q1`) of a given
    /// `hurst_exponent` (between 0 and 1) and `rms_height` (m).
    pub fn new(
        wavenumbers: [f64; 3],
        hurst_exponent: f64,
        rms_height: f64,
    ) -> Result<Self, TheoryError> {
        let [smallest, rolloff, largest] = wavenumbers;
        positive("smallest wave number", smallest)?;
        within(
            "roll-off wave number",
            rolloff,
            rolloff >= smallest,
            "no less than the smallest",
        )?;
        within(
            "largest wave number",
            largest,
            largest > rolloff && largest.is_finite(),
            "more than the roll-off wave number",
        )?;
        within(
            "hurst_exponent",
            hurst_exponent,
            hurst_exponent > 0.0 && hurst_exponent < 1.0,
            "between 0 and 1",
        )?;
        let mut spectrum = Spectrum {
            smallest,
            rolloff,
            largest,
            hurst_exponent,
            plateau: 1.0,
        };
        spectrum.plateau = positive("rms_height", rms_height)?.powi(2) / spectrum.moment(0);
        Ok(spectrum)
    }

    /// Smallest wave number qL, 1/m.
    pub fn smallest_wavenumber(&self) -> f64 {
        self.smallest
    }

    /// Roll-off wave number q0, 1/m.
    pub fn rolloff_wavenumber(&self) -> f64 {
        self.rolloff
    }

    /// Largest wave number q1, 1/m.
    pub fn largest_wavenumber(&self) -> f64 {
        self.largest
    }

    /// Hurst exponent H.
    pub fn hurst_exponent(&self) -> f64 {
        self.hurst_exponent
    }

    /// Height of the plateau C0, m^4.
    pub fn plateau(&self) -> f64 {
        self.plateau
    }

    /// `C(q)`, m^4.
    pub fn density(&self, q: f64) -> f64 {
        if q < self.smallest || q > self.largest {
            0.0
        } else {
            self.plateau
                * (q / self.rolloff)
                    .max(1.0)
                    .powf(-2.0 * (self.hurst_exponent + 1.0))
        }
    }

    /// `I_k = int d2q q^k C` over the whole spectrum.
    pub fn moment(&self, order: i32) -> f64 {
        self.moment_between(order, self.smallest, self.largest)
    }

    /// `I_k` of the wave numbers between `from` and `to`; 0 for an empty interval.
    pub(crate) fn moment_between(&self, order: i32, from: f64, to: f64) -> f64 {
        let order = f64::from(order);
        let power = 2.0 * (self.hurst_exponent + 1.0);
        let (from, to) = (from.max(self.smallest), to.min(self.largest));
        let flat = power_integral(order + 2.0, from, to.min(self.rolloff));
        // In units of q0, so that q0^power never overflows.
        let steep = power_integral(
            order + 2.0 - power,
            from.max(self.rolloff) / self.rolloff,
            to / self.rolloff,
        ) * self.rolloff.powf(order + 2.0);
        2.0 * PI * self.plateau * (flat + steep)
    }

    /// Standard deviation of the heights, m.
    pub fn rms_height(&self) -> f64 {
        self.moment(0).sqrt()
    }

    /// `sqrt <|grad h|^2>`, of both directions together.
    pub fn rms_slope(&self) -> f64 {
        self.moment(2).sqrt()
    }

    /// `sqrt <(laplacian h)^2>`, 1/m.
    pub fn rms_curvature(&self) -> f64 {
        self.moment(4).sqrt()
    }

    /// Moments `(m0, m2, m4)` of a profile: `I_0`, `I_2/2`, `(3/8) I_4`.
    pub fn profile_moments(&self) -> (f64, f64, f64) {
        (self.moment(0), 0.5 * self.moment(2), 0.375 * self.moment(4))
    }

    /// Nayak's bandwidth parameter `m0 m4/m2^2`, 1.5 or more.
    pub fn nayak_parameter(&self) -> f64 {
        let (m0, m2, m4) = self.profile_moments();
        m0 * m4 / (m2 * m2)
    }

    /// Summits per area, 1/m^2: `m4/(6 sqrt3 pi m2)`. Nayak 1971.
    pub fn summit_density(&self) -> f64 {
        let (_, m2, m4) = self.profile_moments();
        m4 / (6.0 * 3.0_f64.sqrt() * PI * m2)
    }

    /// Height of the mean summit above the mean plane, m: `4 sqrt(m0/(pi alpha))`.
    pub fn mean_summit_height(&self) -> f64 {
        4.0 * (self.moment(0) / (PI * self.nayak_parameter())).sqrt()
    }

    /// Mean curvature of the summits, 1/m: `(8/3) sqrt(m4/pi)`.
    pub fn mean_summit_curvature(&self) -> f64 {
        8.0 / 3.0 * (self.profile_moments().2 / PI).sqrt()
    }

    /// The radius `2/h''_rms`, m, of one typical summit.
    pub fn typical_radius(&self) -> f64 {
        2.0 / self.rms_curvature()
    }
}

/// `int_from^to x^(n-1) dx`, 0 for an empty interval, precise at and near n = 0.
fn power_integral(n: f64, from: f64, to: f64) -> f64 {
    if to <= from {
        return 0.0;
    }
    let log = (to / from).ln();
    let growth = n * log;
    let mean = if growth.abs() < 1e-12 {
        1.0
    } else {
        growth.exp_m1() / growth
    };
    from.powf(n) * log * mean
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::quadrature::integrate;

    #[test]
    fn moments_are_integrals_of_the_density() {
        for hurst in [0.3, 0.5, 0.8] {
            let spectrum = Spectrum::new([1.0, 4.0, 50.0], hurst, 0.7).unwrap();
            for order in [0, 1, 2, 4] {
                let value = |q: f64| 2.0 * PI * q.powi(order + 1) * spectrum.density(q);
                let sum = integrate(value, 1.5, 4.0, 1e-11, 0.0).unwrap()
                    + integrate(value, 4.0, 30.0, 1e-11, 0.0).unwrap();
                let closed = spectrum.moment_between(order, 1.5, 30.0);
                assert!((sum / closed - 1.0).abs() < 1e-10);
            }
            assert!((spectrum.rms_height() - 0.7).abs() < 1e-14);
        }
        assert!(Spectrum::new([1.0, 4.0, 4.0], 0.8, 1.0).is_err());
    }
}
