//! Bearing-area model: Ciavarella 2018, for a Dugdale law.
//!
//! Repulsion is Persson's exponential with the constants 3/8 and 2 of Persson 2007 (H = 0.8), which
//! are constants of the model. Attraction acts where the undeformed gap is below the range, by the
//! Gaussian bearing area. Slope and curvature of the roughness do not enter.

use super::error::{TheoryError, positive};
use super::roots::{root, scanned_minimum};
use super::special::erfc;
use std::f64::consts::SQRT_2;

/// A rough surface, described by the two parameters of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BearingArea {
    height_over_range: f64,
    stiffness: f64,
}

impl BearingArea {
    /// `height_over_range` is `h_rms/h0` with `h0 = w/sigma0`; `stiffness` is
    /// `q0 h_rms E*/sigma0` with the smallest self-affine wave number q0.
    pub fn new(height_over_range: f64, stiffness: f64) -> Result<Self, TheoryError> {
        Ok(BearingArea {
            height_over_range: positive("height_over_range", height_over_range)?,
            stiffness: positive("stiffness", stiffness)?,
        })
    }

    /// Net mean pressure at a `mean_gap` in `h_rms`, in sigma0.
    pub fn pressure(&self, mean_gap: f64) -> f64 {
        let repulsion = 0.375 * self.stiffness * (-2.0 * mean_gap).exp();
        repulsion - self.attraction(mean_gap)
    }

    /// Attraction at a `mean_gap` in `h_rms`, in sigma0, positive: the share of the area whose
    /// undeformed gap is within the range.
    pub fn attraction(&self, mean_gap: f64) -> f64 {
        let reach = 1.0 / self.height_over_range;
        0.5 * (erfc((mean_gap - reach) / SQRT_2) - erfc(mean_gap / SQRT_2))
    }

    /// Mean gap (in `h_rms`) at a net `pressure` (in sigma0), on the compressive side of pull-off.
    pub fn mean_gap(&self, pressure: f64) -> Result<f64, TheoryError> {
        let far = self.pull_off().map_or(self.farthest(), |(gap, _)| gap);
        let excess = |gap: f64| self.pressure(gap) - pressure;
        root("an equilibrium", excess, 0.0, far, 1e-12)
    }

    /// A mean gap, in `h_rms`, beyond which both contributions vanish.
    fn farthest(&self) -> f64 {
        10.0 + 1.0 / self.height_over_range
    }

    /// Mean gap (in `h_rms`) and magnitude (in sigma0) of the greatest tension.
    ///
    /// # Errors
    /// Repulsion exceeds attraction at every gap.
    pub fn pull_off(&self) -> Result<(f64, f64), TheoryError> {
        let (gap, least) = scanned_minimum(|u| self.pressure(u), 0.0, self.farthest(), 200);
        if least < 0.0 {
            return Ok((gap, -least));
        }
        Err(TheoryError::NoSolution { what: "a tension" })
    }
}
