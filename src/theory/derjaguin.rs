//! Hertz contact with the energy of its area: Derjaguin 1934.
//!
//! The attraction is that of the Hertz area alone, `pi w R` at every contact radius: half of the
//! correct value at point contact. Kept for comparison.

use super::error::{TheoryError, positive};
use super::hertz;
use super::tabor_map::Sphere;
use std::f64::consts::PI;

/// Force at a contact radius, N: `(4/3) E* a^3/R - pi w R`.
pub fn force(sphere: &Sphere, contact_radius: f64) -> f64 {
    hertz::force(sphere, contact_radius) - PI * sphere.work_of_adhesion() * sphere.radius()
}

/// Force at an `approach` of zero or more in units of the range, in `2 pi w R`.
#[doc(hidden)]
pub fn reduced_force(approach: f64, tabor_parameter: f64) -> Result<f64, TheoryError> {
    positive("tabor_parameter", tabor_parameter)?;
    Ok(super::dmt::hertz_force(approach, tabor_parameter)? - 0.5)
}
