//! Criterion for the adhesion of a rough surface: Pastewka & Robbins 2014, derived again.
//!
//! The contact edge is a line contact with the gap `(4/3) h' t^(3/2)/sqrt(d)`, `d = 4 h'/h''`; the
//! attraction of the strip within its range opposes the repulsive mean pressure.

use super::error::{TheoryError, positive};
use std::f64::consts::PI;

/// A rough surface and its attraction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Root-mean-square slope h'.
    pub rms_slope: f64,
    /// Root-mean-square curvature h'', 1/m.
    pub rms_curvature: f64,
    /// Work of adhesion, J/m^2.
    pub work_of_adhesion: f64,
    /// Contact modulus, Pa.
    pub contact_modulus: f64,
    /// Range of the attraction, m.
    pub range: f64,
    /// Ratio of contact area to `load/(E* h')`; about 2.
    pub area_coefficient: f64,
}

/// Repulsion over attraction; the surface adheres below 1.
///
/// `(h' dr/(kappa l)) (h' d/(4 dr))^(2/3) / (pi (3/16)^(2/3))` with `l = w/E*`.
pub fn stickiness_ratio(edge: &Edge) -> Result<f64, TheoryError> {
    let slope = positive("rms_slope", edge.rms_slope)?;
    let range = positive("range", edge.range)?;
    let length = positive("work_of_adhesion", edge.work_of_adhesion)?
        / positive("contact_modulus", edge.contact_modulus)?;
    let diameter = 4.0 * slope / positive("rms_curvature", edge.rms_curvature)?;
    let coefficient = positive("area_coefficient", edge.area_coefficient)?;
    let left =
        slope * range / (coefficient * length) * (slope * diameter / (4.0 * range)).cbrt().powi(2);
    Ok(left / (PI * 0.1875_f64.cbrt().powi(2)))
}
