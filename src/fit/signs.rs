//! Whether the signs of a curve's approach and force are right.

use std::path::Path;

use super::choice::{CONTACT_AIC, DECISIVE_AIC};
use super::curve_file::{LEAST_ROWS, name};
use super::error::FitError;
use super::estimate::{ModelFit, aic_of_baseline, fit_model};
use super::measured::{Measured, ReversedSigns};
use super::model::Model;
use super::warnings::misses;

/// A force farther away than the largest tension, relative to it, that cannot be noise or drift.
const FAR_FORCE: f64 = 0.2;

/// Refuses a curve that fits far better with the sign of its approach, its force, or both reversed. Holds have no vote:
/// the force of a solid that relaxes falls there, at no change of the approach.
pub(super) fn check_signs(
    measured: &Measured,
    fits: &[ModelFit],
    path: &Path,
) -> Result<(), FitError> {
    let least_of = |fits: &[ModelFit]| {
        let best = fits.iter().min_by(|a, b| a.aic.total_cmp(&b.aic));
        best.cloned()
    };
    let Some(mut best) = least_of(fits) else {
        return Ok(());
    };
    let (least, greatest) = measured.extremes();
    let baseline = measured.baseline();
    let pressed = greatest.force > baseline;
    // No point farther away than the largest tension can be in compression.
    let presses_from_afar = greatest.approach < least.approach
        && greatest.force - baseline > FAR_FORCE * (baseline - least.force);
    // Otherwise no model fits a curve of the wrong sign.
    if pressed && !presses_from_afar && !misses(measured, &best) {
        return Ok(());
    }
    let models = measured.indenter.models();
    let moving = measured.without_holds();
    if moving.samples.len() < LEAST_ROWS {
        return Ok(());
    }
    if moving.samples.len() < measured.samples.len() {
        let refitted = models.iter().filter_map(|model| fit_model(&moving, *model));
        let Some(other) = least_of(&refitted.collect::<Vec<_>>()) else {
            return Ok(());
        };
        best = other;
    }
    let simple = models
        .iter()
        .filter(|model| **model != Model::MaugisDugdale);
    for reversed in ReversedSigns::ALL {
        let other = moving.with_reversed(reversed);
        let fitted = simple.clone().filter_map(|model| fit_model(&other, *model));
        let least = fitted.map(|fit| fit.aic).fold(f64::INFINITY, f64::min);
        if least < best.aic - DECISIVE_AIC {
            let path = name(path);
            return Err(if aic_of_baseline(&moving) - least < CONTACT_AIC {
                FitError::NoContact { path }
            } else if pressed {
                FitError::WrongWay { path }
            } else {
                FitError::NoCompression { path }
            });
        }
    }
    Ok(())
}
