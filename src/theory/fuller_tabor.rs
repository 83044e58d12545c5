//! Summits of Gaussian heights, each a JKR contact: Fuller & Tabor 1975, with the exact JKR curve.
//!
//! Each summit is under displacement control, even if the body is under load control. Separations
//! are in standard deviations above the mean summit, forces per area in `n pi w R`.

use super::error::{TheoryError, finite, not_negative, positive};
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

/// Standard deviations from the mean beyond which there are no summits.
const REACH: f64 = 12.0;

/// Net force per area at a `separation`, in `n pi w R`.
#[doc(hidden)]
pub fn reduced_pressure(theta: f64, separation: f64, path: Path) -> Result<f64, TheoryError> {
    let unit = 1.0 / reduced_height(theta)?;
    let separation = finite("separation", separation)?;
    // The summit that is stretched to its fixed-grips limit.
    let stretched = separation + unit * jkr::reduced_approach(jkr::grip());
    let lowest = match path {
        Path::Loading => separation,
        Path::Unloading => stretched,
    };
    // No wider than the summits: an integral over all that delta* spans would miss them if it is much
    // longer than their standard deviation.
    let (first, last) = (lowest.max(-REACH), lowest.max(0.0) + REACH);
    let absolute = (1e-14 * normal_density(first.max(0.0))).max(f64::MIN_POSITIVE);
    if first > stretched {
        let integrand = |height: f64| {
            let radius = jkr::reduced_radius_at_approach((height - separation) / unit);
            radius.map_or(f64::NAN, jkr::reduced_force) * normal_density(height)
        };
        return integrate(integrand, first, last, 1e-11, absolute);
    }
    // Integrating over the contact radius removes the square root at the fixed-grips limit.
    let to = jkr::reduced_radius_at_approach((last - separation) / unit)?;
    let integrand = |radius: f64| {
        let height = separation + unit * jkr::reduced_approach(radius);
        let rate = 2.0 * radius - (2.0 / (3.0 * radius)).sqrt();
        jkr::reduced_force(radius) * normal_density(height) * unit * rate
    };
    integrate(integrand, jkr::grip(), to, 1e-11, absolute)
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
    // Of a rough surface it may be below the least number.
    let tension = not_negative("pull-off", -least)?;
    Ok((separation, tension / 1.5))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From the integral over the heights between -12 and 12, in 60 parts (SciPy, quad). Summits of nearly one height all follow the
    /// curve of one: -4/3 at no separation, and 1.5 of pull-off.
    #[test]
    fn summits_of_nearly_one_height_are_not_missed() {
        for (theta, separation, apart, together) in [
            (1e-6, 0.0, -1.333_333_331_416_662, -0.666_651_043_986_889),
            (1e-6, 3.0, -1.333_450_787_711_603, -0.001_799_849_077_442_6),
            (1e-2, -1.0, -1.314_345_017_275_757, -1.101_321_807_326_9),
            (2.0, -1.0, 0.015_066_246_742_395, 0.209_350_024_284_805),
        ] {
            for (path, expected) in [(Path::Unloading, apart), (Path::Loading, together)] {
                let found = reduced_pressure(theta, separation, path).unwrap();
                assert!(
                    (found / expected - 1.0).abs() < 1e-8,
                    "{theta} {separation} {path:?}: {found}"
                );
            }
        }
        let (_, tension) = reduced_pull_off(1e-6).unwrap();
        assert!((tension - 1.0).abs() < 1e-6, "{tension}");
    }

    #[test]
    fn a_pull_off_below_the_least_number_is_none() {
        assert_eq!(reduced_pull_off(1e5).unwrap().1, 0.0);
    }
}
