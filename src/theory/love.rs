//! Displacement of a half-space under uniform pressure on a rectangle or a disc.

use super::error::{TheoryError, not_negative, positive};
use super::special::{elliptic, elliptic_complement};
use crate::elastic::love_displacement;
use std::f64::consts::PI;

/// Displacement at (x, y) under unit pressure on `|x| < a, |y| < b`, times E*; a length.
///
/// The point is relative to the centre of the rectangle, `half_sides` is (a, b). Love 1929;
/// Johnson 1985 eq. 3.25.
pub fn rectangle(x: f64, y: f64, half_sides: (f64, f64)) -> Result<f64, TheoryError> {
    let a = positive("half_sides", half_sides.0)?;
    let b = positive("half_sides", half_sides.1)?;
    Ok(love_displacement(x, y, a, b))
}

/// Displacement at distance `r` from the centre of a disc of `radius` under unit pressure, times
/// E*; a length. Johnson 1985, section 3.4.
pub fn disc(r: f64, radius: f64) -> Result<f64, TheoryError> {
    let radius = positive("radius", radius)?;
    let r = not_negative("r", r)?;
    Ok(if r <= radius {
        let ratio = r / radius;
        4.0 * radius / PI * elliptic(ratio * ratio).1
    } else {
        let ratio = radius / r;
        let rest = (1.0 - ratio) * (1.0 + ratio);
        // Far away E - (1-m) K cancels; its series starts with (pi/4) m.
        if ratio < 0.02 {
            let m = ratio * ratio;
            return Ok(r * m * (1.0 + m * (0.125 + m * (3.0 / 64.0 + m * 25.0 / 1024.0))));
        }
        let (k, e) = elliptic_complement(rest);
        4.0 * r / PI * (e - rest * k)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn far_away_only_the_force_counts() {
        let far = rectangle(30.0, 40.0, (0.5, 0.5)).unwrap();
        assert!((far * PI * 50.0 - 1.0).abs() < 1e-4);
        let disc_far = disc(1000.0, 1.0).unwrap();
        assert!((disc_far * 1000.0 - 1.0).abs() < 1e-6);
    }

    #[test]
    fn series_of_the_disc_meets_its_formula() {
        let near = disc(50.000_001, 1.0).unwrap();
        let inner = disc(49.999_999, 1.0).unwrap();
        assert!((near / inner - 1.0 + 4e-8).abs() < 1e-10);
    }

    #[test]
    fn four_quarters_make_a_square() {
        let whole = rectangle(0.3, 0.1, (0.5, 0.5)).unwrap();
        let mut parts = 0.0;
        for (cx, cy) in [(0.25, 0.25), (-0.25, 0.25), (0.25, -0.25), (-0.25, -0.25)] {
            parts += rectangle(0.3 - cx, 0.1 - cy, (0.25, 0.25)).unwrap();
        }
        assert!((whole - parts).abs() < 1e-14);
    }
}
