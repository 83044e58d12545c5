//! Cone and flat punch on a half-space without adhesion. Sneddon 1965.

use super::error::{TheoryError, not_negative, positive, within};
use std::f64::consts::FRAC_PI_2;

/// A cone `r tan(slope_angle)` on a half-space; the angle is between flank and surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    tangent: f64,
    contact_modulus: f64,
}

impl Cone {
    /// A cone of `slope_angle` (radian, between 0 and pi/2) on a half-space of `contact_modulus`
    /// (Pa). Small slopes are assumed, as everywhere.
    pub fn new(slope_angle: f64, contact_modulus: f64) -> Result<Self, TheoryError> {
        within(
            "slope_angle",
            slope_angle,
            slope_angle > 0.0 && slope_angle < FRAC_PI_2,
            "between 0 and pi/2",
        )?;
        Ok(Cone {
            tangent: slope_angle.tan(),
            contact_modulus: positive("contact_modulus", contact_modulus)?,
        })
    }

    /// Approach at a contact radius, m: `(pi/2) a tan(b)`.
    pub fn approach(&self, contact_radius: f64) -> f64 {
        FRAC_PI_2 * contact_radius * self.tangent
    }

    /// Force at a contact radius, N: `(pi/2) E* a^2 tan(b)`.
    pub fn force(&self, contact_radius: f64) -> f64 {
        FRAC_PI_2 * self.contact_modulus * contact_radius * contact_radius * self.tangent
    }

    /// Contact radius under a compressive `force` (N), m.
    pub fn contact_radius(&self, force: f64) -> Result<f64, TheoryError> {
        let force = not_negative("force", force)?;
        Ok((force / (FRAC_PI_2 * self.contact_modulus * self.tangent)).sqrt())
    }

    /// Mean pressure over the contact, Pa: `(E*/2) tan(b)` at any load.
    pub fn mean_pressure(&self) -> f64 {
        0.5 * self.contact_modulus * self.tangent
    }

    /// Pressure at distance `r` from the axis, Pa: `(E*/2) tan(b) acosh(a/r)`; infinite at the
    /// apex, 0 outside.
    pub fn pressure(&self, contact_radius: f64, r: f64) -> f64 {
        self.mean_pressure() * (contact_radius / r.abs()).max(1.0).acosh()
    }
}

/// Force on a flat punch of `radius` (m) at `approach` (m), N: `2 E* a delta`.
pub fn punch_force(radius: f64, contact_modulus: f64, approach: f64) -> Result<f64, TheoryError> {
    Ok(
        2.0 * positive("contact_modulus", contact_modulus)?
            * positive("radius", radius)?
            * approach,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::quadrature::integrate;
    use std::f64::consts::PI;

    #[test]
    fn pressure_sums_to_the_force() {
        let cone = Cone::new(0.1, 5.0).unwrap();
        let sum = integrate(
            |r| 2.0 * PI * r * cone.pressure(0.7, r),
            0.0,
            0.7,
            1e-10,
            0.0,
        )
        .unwrap();
        assert!((sum / cone.force(0.7) - 1.0).abs() < 1e-9);
        assert!((cone.contact_radius(cone.force(0.7)).unwrap() - 0.7).abs() < 1e-15);
    }
}
