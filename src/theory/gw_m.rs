//! Greenwood & Williamson's summits, each with the constant attraction `2 pi w R` of DMT once it
//! touches: Maugis 1996 (GW-M).
//!
//! The only parameter is `theta` of [`Summits::adhesion_parameter`]. Separations are in standard
//! deviations above the mean summit, pressures in `n 2 pi w R`.

use super::error::{TheoryError, not_negative, positive};
use super::gw::{Summits, scaled_tail, tail_three_halves, tail_zero};
use super::roots::root;
use super::special::normal_density;
use std::f64::consts::PI;

/// Net pressure at a `separation`: `(2/(3 pi)) theta F_(3/2) - F_0`.
#[doc(hidden)]
pub fn reduced_pressure(theta: f64, separation: f64) -> Result<f64, TheoryError> {
    let theta = not_negative("theta", theta)?;
    Ok(2.0 / (3.0 * PI) * theta * tail_three_halves(separation)? - tail_zero(separation))
}

/// Separation and magnitude of the greatest tension.
///
/// There `(theta/pi) F_(1/2)` equals the density; their ratio decreases with the separation.
#[doc(hidden)]
pub fn reduced_pull_off(theta: f64) -> Result<(f64, f64), TheoryError> {
    let theta = positive("theta", theta)?;
    // In logarithms, since the ratio spans many decades.
    let excess = |t: f64| scaled_tail(2, t).map_or(f64::NAN, |tail| (theta / PI * tail).ln());
    let separation = root("a pull-off", excess, -25.0, 300.0, 1e-14)?;
    // The two parts nearly cancel at large separations; divided by the density they stay of order
    // 1.
    let attraction = scaled_tail_zero(separation);
    let repulsion = 2.0 / (3.0 * PI) * theta * scaled_tail(4, separation)?;
    Ok((
        separation,
        normal_density(separation) * (attraction - repulsion),
    ))
}

fn scaled_tail_zero(t: f64) -> f64 {
    if t < 30.0 {
        tail_zero(t) / normal_density(t)
    } else {
        // Mills' ratio.
        let square = t * t;
        (1.0 - 1.0 / square + 3.0 / (square * square)) / t
    }
}

/// Net nominal pressure at a `separation`, Pa.
pub fn pressure(summits: &Summits, separation: f64) -> Result<f64, TheoryError> {
    let attraction = 2.0 * PI * summits.summit().work_of_adhesion() * summits.summit().radius();
    Ok(summits.pressure(separation)? - summits.density() * attraction * tail_zero(separation))
}

/// Magnitude of the greatest nominal tension, Pa.
pub fn pull_off(summits: &Summits) -> Result<f64, TheoryError> {
    let unit = 2.0 * PI * summits.summit().work_of_adhesion() * summits.summit().radius();
    Ok(summits.density() * unit * reduced_pull_off(summits.adhesion_parameter()?)?.1)
}

/// Separation at a net nominal `pressure` (Pa), on the compressive side of pull-off. Without
/// adhesion this is the Greenwood-Williamson model.
pub fn separation(summits: &Summits, pressure: f64) -> Result<f64, TheoryError> {
    let far = if summits.summit().work_of_adhesion() > 0.0 {
        reduced_pull_off(summits.adhesion_parameter()?)?.0
    } else {
        30.0
    };
    let excess = |t: f64| self::pressure(summits, t).map_or(f64::NAN, |p| p - pressure);
    root("an equilibrium", excess, -25.0, far, 1e-14)
}
