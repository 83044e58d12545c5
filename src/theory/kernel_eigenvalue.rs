//! Compliance of a periodic grid on a half-space, mode by mode, for three discretisations.
//!
//! The three differ by a fifth to two fifths at the shortest wave of a grid.

use super::error::{TheoryError, within};
use std::f64::consts::PI;

/// Displacement over pressure of one wave of the grid, times E*; lengths in units of the box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eigenvalue {
    /// Pressure and displacement are that one wave: `2/|q|`.
    pub spectral: f64,
    /// Pressure is constant on each pixel, displacement is evaluated at its centre.
    pub pixel_centre: f64,
    /// Pressure is constant on each pixel, displacement is averaged over it.
    pub pixel_mean: f64,
}

/// Eigenvalue of the wave (k, l), not both 0, on `points` by `points` in a box of side 1.
///
/// Sums the aliases `q + 2 pi points (i, j)`, `|i|, |j| <= 500`: a million terms, accurate to 1e-7.
pub fn eigenvalue(k: i64, l: i64, points: usize) -> Result<Eigenvalue, TheoryError> {
    const REACH: i64 = 500;
    within(
        "points",
        points as f64,
        (1..=1 << 20).contains(&points),
        "between 1 and 2^20",
    )?;
    let n = points as i64;
    within(
        "wave",
        k.unsigned_abs().max(l.unsigned_abs()) as f64,
        (k != 0 || l != 0) && k.abs() <= n / 2 && l.abs() <= n / 2,
        "not both 0, and no more than half the points",
    )?;
    // sin(x)/x at the alias m of an index, x = pi (index + m points)/points.
    let sinc = |index: i64, alias: i64| {
        let x = PI * (index + alias * n) as f64 / n as f64;
        if x == 0.0 { 1.0 } else { x.sin() / x }
    };
    let (mut centre, mut mean) = (0.0, 0.0);
    for i in -REACH..=REACH {
        let along = sinc(k, i);
        for j in -REACH..=REACH {
            let shape = along * sinc(l, j);
            let q = 2.0 * PI * ((k + i * n) as f64).hypot((l + j * n) as f64);
            centre += 2.0 / q * shape;
            mean += 2.0 / q * shape * shape;
        }
    }
    Ok(Eigenvalue {
        spectral: 1.0 / (PI * (k as f64).hypot(l as f64)),
        pixel_centre: centre,
        pixel_mean: mean,
    })
}
