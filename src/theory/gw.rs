//! Independent Hertz contacts of summits of one radius and Gaussian heights: Greenwood & Williamson
//! 1966. Valid for small contact areas only.

use super::error::{TheoryError, positive, within};
use super::hertz;
use super::special::{erfc, normal_density};
use super::tabor_map::Sphere;
use std::f64::consts::{PI, SQRT_2};

/// The summits of a rough surface in contact with a flat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summits {
    summit: Sphere,
    density: f64,
    rms_height: f64,
}

impl Summits {
    /// `density` summits per area (1/m^2), each a `summit`, with heights of standard deviation
    /// `rms_height` (m).
    pub fn new(summit: Sphere, density: f64, rms_height: f64) -> Result<Self, TheoryError> {
        Ok(Summits {
            summit,
            density: positive("density", density)?,
            rms_height: positive("rms_height", rms_height)?,
        })
    }

    /// One summit.
    pub fn summit(&self) -> &Sphere {
        &self.summit
    }

    /// Summits per area, 1/m^2.
    pub fn density(&self) -> f64 {
        self.density
    }

    /// Standard deviation of the summit heights, m.
    pub fn rms_height(&self) -> f64 {
        self.rms_height
    }

    /// Nominal pressure with the flat `separation` standard deviations above the mean summit, Pa.
    pub fn pressure(&self, separation: f64) -> Result<f64, TheoryError> {
        let one = self.summit.radius() * self.rms_height;
        Ok(self.density * hertz::force(&self.summit, one.sqrt()) * tail_three_halves(separation)?)
    }

    /// Contact area per nominal area; it can exceed 1 in this model.
    pub fn contact_area_fraction(&self, separation: f64) -> f64 {
        PI * self.density * self.summit.radius() * self.rms_height * tail_one(separation)
    }

    /// Contacts per area, 1/m^2.
    pub fn contact_density(&self, separation: f64) -> f64 {
        self.density * tail_zero(separation)
    }

    /// Adhesion parameter `theta = E* sigma^(3/2)/(w sqrt R)` of Fuller & Tabor 1975; large for
    /// rough surfaces.
    pub fn adhesion_parameter(&self) -> Result<f64, TheoryError> {
        let work = positive("work_of_adhesion", self.summit.work_of_adhesion())?;
        let ratio = self.rms_height / self.summit.radius();
        Ok(self.summit.contact_modulus() * self.rms_height * ratio.sqrt() / work)
    }
}

/// `F_0(t) = int_t^inf phi(z) dz`, phi the normal density.
#[doc(hidden)]
pub fn tail_zero(t: f64) -> f64 {
    0.5 * erfc(t / SQRT_2)
}

/// `F_1(t) = int_t^inf (z-t) phi(z) dz`.
#[doc(hidden)]
pub fn tail_one(t: f64) -> f64 {
    if t < 3.0 {
        normal_density(t) - t * tail_zero(t)
    } else {
        // The difference would cancel.
        normal_density(t) * scaled_tail_by_logarithm(1.0, t)
    }
}

/// `F_(3/2)(t) = int_t^inf (z-t)^(3/2) phi(z) dz`, for t of -30 or more.
#[doc(hidden)]
pub fn tail_three_halves(t: f64) -> Result<f64, TheoryError> {
    Ok(normal_density(t) * scaled_tail(4, t)?)
}

/// `int_0^inf y^((n-1)/2) exp(-t y - y^2/2) dy` for even n, the tail over the density.
///
/// With `y = s^2` the integrand is even and entire in s, so that the trapezoid rule over the whole
/// line converges faster than any power of its step.
pub(crate) fn scaled_tail(n: i32, t: f64) -> Result<f64, TheoryError> {
    within(
        "separation",
        t,
        t >= -30.0,
        "-30 standard deviations or more",
    )?;
    let exponent = |s: f64| -s * s * (t + 0.5 * s * s);
    let step = 0.1 / (1.0 + t.abs()).sqrt();
    // The place where y (t + y/2) is 50: y = -t + sqrt(t^2 + 100), without cancellation or
    // overflow.
    let end = (100.0 / (t + t.hypot(10.0))).sqrt() + 2.0 * step;
    let mut sum = 0.0;
    let mut s = step;
    // At most 440 terms, at the least t, and 70 far out.
    while s < end {
        sum += s.powi(n) * exponent(s).exp();
        s += step;
    }
    Ok(2.0 * step * sum)
}

/// `int_0^inf y^k exp(-t y - y^2/2) dy` for t > 0, by the trapezoid rule in log y.
fn scaled_tail_by_logarithm(k: f64, t: f64) -> f64 {
    if t == f64::INFINITY {
        return 0.0;
    }
    let step = 0.05;
    let mut sum = 0.0;
    let mut log = -(40.0 + t.ln());
    // At most 15 000 terms, at the largest number.
    while log < 3.0 {
        let y = f64::exp(log);
        sum += ((k + 1.0) * log - y * (t + 0.5 * y)).exp();
        log += step;
    }
    step * sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::quadrature::integrate_to_infinity;

    #[test]
    fn tails_are_their_integrals() {
        for t in [-3.0, 0.0, 0.7, 2.9, 3.1, 8.0] {
            let density = |y: f64| normal_density(t + y);
            let sum = |k: f64| {
                integrate_to_infinity(|y| y.powf(k) * density(y), 0.0, 1.0, 1e-12, 0.0).unwrap()
            };
            assert!((tail_one(t) / sum(1.0) - 1.0).abs() < 1e-11, "{t}");
            assert!(
                (tail_three_halves(t).unwrap() / sum(1.5) - 1.0).abs() < 1e-10,
                "{t}"
            );
        }
        assert!(tail_three_halves(f64::NAN).is_err());
    }
}
