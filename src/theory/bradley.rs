//! Rigid sphere and flat: Bradley 1932, in the approximation of Derjaguin 1934.
//!
//! The force is `2 pi R` times the energy per area of flats at the least gap, for every law; valid
//! while the radius is much larger than the range.

use super::error::{TheoryError, positive, within};
use super::laws::Law;
use super::tabor_map::Sphere;
use std::f64::consts::PI;

/// Force at a least `gap` in units of the range, in `2 pi w R`; negative attracts.
#[doc(hidden)]
pub fn reduced_force(law: Law, gap: f64) -> f64 {
    law.energy(gap)
}

/// Force at a least `gap` (m, zero or more; for Lennard-Jones above minus the `range`), N;
/// negative attracts.
pub fn force(sphere: &Sphere, law: Law, range: f64, gap: f64) -> Result<f64, TheoryError> {
    let range = positive("range", range)?;
    let least = if law == Law::LennardJones {
        -range
    } else {
        0.0
    };
    within(
        "gap",
        gap,
        gap.is_finite() && gap >= least && gap > -range,
        "zero or more (Lennard-Jones: above minus the range)",
    )?;
    Ok(2.0 * PI * sphere.work_of_adhesion() * sphere.radius() * reduced_force(law, gap / range))
}
