//! Whether the signs of a curve's approach and force are right.

use std::path::Path;

use super::akaike::aic_of_baseline;
use super::choice::{CONTACT_AIC, DECISIVE_AIC};
use super::curve_file::{LEAST_ROWS, Sample, name};
use super::error::FitError;
use super::estimate::{ModelFit, fit_model};
use super::measured::{Measured, ReversedSigns};
use super::model::Model;
use super::warnings::misses;

/// A force farther away than the largest tension, relative to it, that cannot be noise or drift.
const FAR_FORCE: f64 = 0.2;
/// Share of the squares of the forces about their mean that the best model of a right sign does not leave, whatever the solid.
const UNEXPLAINED: f64 = 0.5;
/// Share of its squares that a model of reversed signs leaves, if it misses the curve too.
const FAR_BETTER: f64 = 0.25;
/// Noises that a force of compression exceeds, the share of the points that are the closest, and that of the greatest tension which these have
/// where a tension never gives way to contact.
const PRESSED_NOISES: f64 = 5.0;
const CLOSEST: f64 = 0.05;
const AS_PULLED: f64 = 0.9;

/// Refuses a curve that a model describes with the sign of its approach, its force, or both reversed, or that is far better described so where
/// the models of the signs as given say nothing of it. Where no model describes the curve either way, as of solids that relax, detectors at
/// their limit and tilted baselines, a better fit says nothing of the signs. Holds have no vote: the force of a solid that relaxes falls there, at no change of the approach.
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
    let squares = squares_about_mean(&moving.samples);
    let described = ReversedSigns::ALL.into_iter().filter_map(|reversed| {
        let other = moving.with_reversed(reversed);
        let fitted = simple.clone().filter_map(|model| fit_model(&other, *model));
        let fit = least_of(&fitted.collect::<Vec<_>>())?;
        let is_far_better = best.sum_of_squares > UNEXPLAINED * squares
            && fit.sum_of_squares < FAR_BETTER * best.sum_of_squares;
        let is_described = fit.aic < best.aic - DECISIVE_AIC
            && (is_far_better || !misses(&other, &fit))
            && !never_presses(&other, &fit);
        is_described.then_some((reversed, fit.aic))
    });
    let Some((reversed, aic)) = described.min_by(|a, b| a.1.total_cmp(&b.1)) else {
        return Ok(());
    };
    let path = name(path);
    Err(if aic_of_baseline(&moving) - aic < CONTACT_AIC {
        FitError::NoContact { path }
    } else if pressed {
        let remedy = reversed.remedy();
        FitError::WrongWay { path, remedy }
    } else {
        FitError::NoCompression { path }
    })
}

/// Whether the tension of a curve is still the greatest where it ends closest, without compression: no contact, but the reversal of a
/// compression that reached the limit of a detector.
fn never_presses(measured: &Measured, fit: &ModelFit) -> bool {
    let (least, greatest) = measured.extremes();
    let baseline = measured.baseline();
    let mut closest = measured.samples.clone();
    closest.sort_by(|a, b| b.approach.total_cmp(&a.approach));
    closest.truncate(((CLOSEST * closest.len() as f64) as usize).max(1));
    closest.sort_by(|a, b| a.force.total_cmp(&b.force));
    let there = closest[closest.len() / 2].force - baseline;
    greatest.force - baseline < PRESSED_NOISES * fit.noise
        && there < AS_PULLED * (least.force - baseline)
}

/// Sum of the squares of the forces about their mean, N^2.
fn squares_about_mean(samples: &[Sample]) -> f64 {
    let forces = || samples.iter().map(|sample| sample.force);
    let mean = forces().sum::<f64>() / samples.len().max(1) as f64;
    forces().map(|force| (force - mean).powi(2)).sum()
}
