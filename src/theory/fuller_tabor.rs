//! Summits of Gaussian heights, each a JKR contact: Fuller & Tabor 1975, with the exact JKR curve.
//!
//! Each summit is under displacement control, even if the body is under load control. Separations
//! are in standard deviations above the mean summit, forces per area in `n pi w R`.

use super::error::{TheoryError, finite, positive};
use super::jkr;
use super::quadrature::integrate;
use super::roots::scanned_minimum;
use super::special::normal_density;
use std::f64::consts::PI;

/// Loading or unloading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Path {
    /// Loading: summits that reach the flat; a summit jumps in at zero gap.
    Loading,
    /// Unloading: also stretched summits; a summit stays in contact up to its fixed-grips limit.
    Unloading,
}

/// Standard deviation of the heights in units of `delta*`: `(4 theta/(3 pi))^(2/3)`.
pub(crate) fn reduced_height(theta: f64) -> Result<f64, TheoryError> {
    Ok((4.0 * positive("theta", theta)? / (3.0 * PI))
        .cbrt()
        .powi(2))
}

/// Net force per area at a `separation`, in `n pi w R`.
#[doc(hidden)]
pub fn reduced_pressure(theta: f64, separation: f64, path: Path) -> Result<f64, TheoryError> {
    let unit = 1.0 / reduced_height(theta)?;
    let separation = finite("separation", separation)?;
    // Integrating over the contact radius removes the square root at the fixed-grips limit.
    let from = match path {
        Path::Loading => jkr::zero_approach(),
        Path::Unloading => jkr::grip(),
    };
    let last = (separation.max(0.0) + 12.0 - separation) / unit;
    let to = jkr::reduced_radius_at_approach(last)?;
    let integrand = |radius: f64| {
        let height = separation + unit * jkr::reduced_approach(radius);
        let rate = 2.0 * radius - (2.0 / (3.0 * radius)).sqrt();
        jkr::reduced_force(radius) * normal_density(height) * unit * rate
    };
    let scale = normal_density(separation.max(0.0));
    integrate(integrand, from, to, 1e-11, 1e-14 * scale)
}

/// Separation and magnitude (in `n 1.5 pi w R`) of the greatest tension on unloading.
#[doc(hidden)]
pub fn reduced_pull_off(theta: f64) -> Result<(f64, f64), TheoryError> {
    let unit = 1.0 / reduced_height(theta)?;
    let at = |h: f64| reduced_pressure(theta, h, Path::Unloading).unwrap_or(f64::NAN);
    // The summit of mean height jumps off 0.91 delta* above it; a rough surface is held by its
    // highest summits.
    let (low, high) = (-4.0, 8.0 + unit + 0.5 * theta.cbrt().powi(2));
    let (separation, least) = scanned_minimum(at, low, high, 60);
    positive("pull-off", -least)?;
    Ok((separation, -least / 1.5))
}
