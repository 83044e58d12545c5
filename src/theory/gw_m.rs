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

/// Separation and magnitude of the greatest tension, which is 0 if it is below the least number, as for rough surfaces.
///
/// There `(theta/pi) F_(1/2)` equals the density; their ratio decreases with the separation.
#[doc(hidden)]
pub fn reduced_pull_off(theta: f64) -> Result<(f64, f64), TheoryError> {
    let theta = positive("theta", theta)?;
    // In logarithms, since the ratio spans many decades.
    let excess = |t: f64| scaled_tail(2, t).map_or(f64::NAN, |tail| (theta / PI * tail).ln());
    // Far away the tail is sqrt(pi)/2 t^(-3/2).
    let far = theta.cbrt().powi(2).max(300.0);
    let separation = root("a pull-off", excess, -25.0, far, 1e-14)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::Sphere;

    /// A rough surface hardly attracts, and has the separations of its loads nevertheless: (4/3) n E* sqrt(R) sigma^(3/2) F_(3/2)(t), which at
    /// t = 0 is 0.43002 of it.
    #[test]
    fn a_rough_surface_has_no_pull_off_and_all_its_loads() {
        for theta in [1e2, 2e4, 1e9, 1e30] {
            let (separation, tension) = reduced_pull_off(theta).unwrap();
            // The condition of the extremum, by the tail far away.
            let tail = 0.5 * PI.sqrt() * separation.powf(-1.5);
            assert!((theta / PI * tail - 1.0).abs() < 0.01 || theta < 1e3);
            assert!(tension >= 0.0 && (tension == 0.0 || theta < 1e3));
        }
        let sphere = Sphere::new(1.0, 1.0, 1e-6).unwrap();
        let summits = Summits::new(sphere, 1.0, 1.0).unwrap();
        assert!(
            separation(&summits, 4.0 / 3.0 * 0.430_019_994)
                .unwrap()
                .abs()
                < 1e-5
        );
    }
}
