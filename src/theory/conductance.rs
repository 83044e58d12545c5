//! Heat conduction through a contact from its stiffness: Barber 2003.
//!
//! Steady conduction through a set of contact spots and the small indentation of the same spots are
//! the same harmonic problem, so the conductance follows from the stiffness at fixed contact, for
//! spots of any number and shape. With electrical conductivities in S/m the conductance is in S. No
//! heat flows through the gap.

use super::error::{TheoryError, not_negative, positive};

/// Harmonic mean `2 k1 k2/(k1 + k2)` of two conductivities, W/(m K).
pub fn combined_conductivity(first: f64, second: f64) -> Result<f64, TheoryError> {
    let (first, second) = (
        positive("conductivity", first)?,
        positive("conductivity", second)?,
    );
    Ok(2.0 / (1.0 / first + 1.0 / second))
}

/// Conductance `(k/E*) S` of a contact whose stiffness at fixed contact is S (N/m), W/K; for a
/// stiffness per area (Pa/m) the conductance per area, W/(m^2 K).
pub fn from_stiffness(
    conductivity: f64,
    contact_modulus: f64,
    stiffness: f64,
) -> Result<f64, TheoryError> {
    Ok(
        positive("conductivity", conductivity)? / positive("contact_modulus", contact_modulus)?
            * not_negative("stiffness", stiffness)?,
    )
}

/// Conductance of one circular spot, W/K: `2 a k`.
pub fn circle(conductivity: f64, radius: f64) -> Result<f64, TheoryError> {
    Ok(2.0 * positive("radius", radius)? * positive("conductivity", conductivity)?)
}
