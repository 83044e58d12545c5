//! Friction of an adhesive contact: a shear strength times the contact area. Homola, Israelachvili,
//! McGuiggan & Gee 1990.

use super::error::{TheoryError, not_negative};
use super::jkr;
use super::tabor_map::Sphere;
use std::f64::consts::PI;

/// Friction force `tau A`, N, of a `shear_strength` (Pa) and a `contact_area` (m^2).
///
/// The area is that of hard-wall contact; for Lennard-Jones state which gap counts as contact.
pub fn force(shear_strength: f64, contact_area: f64) -> Result<f64, TheoryError> {
    Ok(not_negative("shear_strength", shear_strength)?
        * not_negative("contact_area", contact_area)?)
}

/// Friction of a JKR sphere under a normal `force` (N), N: finite at no load, and proportional to
/// the power 2/3 of large loads.
pub fn jkr_force(
    sphere: &Sphere,
    shear_strength: f64,
    normal_force: f64,
) -> Result<f64, TheoryError> {
    let radius = jkr::contact_radius(sphere, normal_force)?;
    force(shear_strength, PI * radius * radius)
}
