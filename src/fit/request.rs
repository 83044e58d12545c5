//! A fit with all that may be asked of it: what is free, what is known, and what follows from the result.

use std::path::Path;

use super::advice::advise_curve;
use super::calibration::Calibration;
use super::choice::{FitResult, fit_curve};
use super::curve_file::ForceCurve;
use super::error::FitError;
use super::indenter::Indenter;
use super::measured::Freedom;
use super::relaxation::fit_relaxation;

/// What is asked of a fit; by default the approach of first touch is fitted, and nothing else beside the models.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FitRequest {
    /// The undeformed surfaces touch at approach 0; else that approach is fitted.
    pub contact_at_zero: bool,
    /// Fit the force where nothing acts; else it is 0.
    pub baseline: bool,
    /// Fit the slope of that force too.
    pub baseline_slope: bool,
    /// Range of the attraction, m, where it is known.
    pub range: Option<f64>,
    /// Relative standard deviation of the radius.
    pub radius_error: f64,
    /// Relative standard deviation of the spring constant.
    pub spring_error: f64,
    /// Fit one relaxation time of the solid beside.
    pub relaxation: bool,
    /// Say which model suits, with probabilities learned from full fields of spheres.
    pub advise: bool,
}

impl FitRequest {
    /// Fits a curve of a tip; `path` is for messages.
    ///
    /// # Errors
    /// As [`fit_curve`], and [`fit_relaxation`] where that is asked for.
    pub fn fit(
        &self,
        curve: &ForceCurve,
        path: &Path,
        indenter: Indenter,
    ) -> Result<FitResult, FitError> {
        let freedom = Freedom {
            approach_offset: !self.contact_at_zero,
            force_offset: self.baseline || self.baseline_slope,
            baseline_slope: self.baseline_slope,
            range: self.range,
        };
        let mut result = fit_curve(curve, path, indenter, freedom)?;
        if self.relaxation {
            result.relaxation = Some(fit_relaxation(curve, path, &result)?);
        }
        Calibration::new(self.radius_error, self.spring_error).widen(&mut result);
        if self.advise {
            result.advice = advise_curve(&result);
            if result.advice.is_none() {
                let missing =
                    "no advice: it needs a fit of each of the four models, and one of them failed";
                result.warnings.push(missing.to_owned());
            }
        }
        Ok(result)
    }
}
