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
    for reversed in ReversedSigns::ALL {
        let other = moving.with_reversed(reversed);
        let fitted = simple.clone().filter_map(|model| fit_model(&other, *model));
        let Some(fit) = least_of(&fitted.collect::<Vec<_>>()) else {
            continue;
        };
        let is_far_better = best.sum_of_squares > UNEXPLAINED * squares
            && fit.sum_of_squares < FAR_BETTER * best.sum_of_squares;
        if fit.aic < best.aic - DECISIVE_AIC
            && (is_far_better || !misses(&other, &fit))
            && !never_presses(&other, &fit)
        {
            let path = name(path);
            return Err(if aic_of_baseline(&moving) - fit.aic < CONTACT_AIC {
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::fit::test_noise::normal;
    use crate::fit::{FitError, FitRequest, FitResult, ForceCurve, Indenter, Sample};

    const RADIUS: f64 = 5e-6;
    const POINTS: u32 = 240;

    /// Loading of a sphere without adhesion from six depths before first touch, with noise of 1 % of the greatest force; `more` is the force at
    /// a share of the whole approach, from that of the sphere over its greatest.
    fn sphere(more: impl Fn(f64, f64) -> f64) -> ForceCurve {
        let mut normal = normal(1);
        let samples = (0..POINTS).map(|i| {
            let share = f64::from(i) / f64::from(POINTS - 1);
            let approach = 0.5e-6 * (7.0 * share - 6.0);
            let hertz = (7.0 * share - 6.0).max(0.0).powf(1.5);
            Sample {
                approach,
                force: 5e-8 * (more(share, hertz) + 0.01 * normal()),
            }
        });
        ForceCurve {
            samples: samples.collect(),
            ..ForceCurve::default()
        }
    }

    fn fitted(curve: &ForceCurve, baseline: bool, relaxation: bool) -> Result<FitResult, FitError> {
        let mut request = FitRequest::default();
        (request.baseline, request.relaxation) = (baseline, relaxation);
        request.fit(curve, Path::new("made"), Indenter::from(RADIUS))
    }

    /// Checks that a curve is fitted, and described by no model.
    fn has_right_signs(what: &str, curve: &ForceCurve, baseline: bool, relaxation: bool) {
        let found = fitted(curve, baseline, relaxation).unwrap_or_else(|e| panic!("{what}: {e}"));
        assert!(!found.describes_curve, "{what}");
        assert_eq!(found.relaxation.is_some(), relaxation, "{what}");
    }

    /// Checks that a curve is refused where its approach is reversed.
    fn is_refused_reversed(what: &str, curve: &ForceCurve) {
        let turned = |sample: &Sample| Sample {
            approach: -sample.approach,
            ..*sample
        };
        let turned = ForceCurve {
            samples: curve.samples.iter().map(turned).collect(),
            ..curve.clone()
        };
        let found = fitted(&turned, false, false);
        let is_refused = matches!(found, Err(FitError::WrongWay { .. }));
        assert!(is_refused, "{what}, reversed: {found:?}");
    }

    /// No model describes these curves, nor their reversals, one of which was a little better each time: a tilted baseline, a detector at its
    /// limit, a surface that gives way. The sign was said to be wrong.
    #[test]
    fn a_curve_that_no_model_describes_keeps_its_signs() {
        let tilted = sphere(|share, hertz| hertz + 0.3 * share);
        has_right_signs("tilt", &tilted, true, false);
        let limited = sphere(|_, hertz| hertz.min(0.5));
        let gives_way = sphere(|share, hertz| if share > 0.95 { 0.5 * hertz } else { hertz });
        for (what, curve) in [("limit", limited), ("pop-in", gives_way)] {
            has_right_signs(what, &curve, false, false);
            is_refused_reversed(what, &curve);
        }
    }

    /// A standard linear solid of 20 and 60 kPa and 0.15 s, whose approach slows down to a twentieth: its force falls before the loading ends.
    #[test]
    fn a_loading_that_slows_down_has_the_right_sign() {
        let mut normal = normal(2);
        let count = 300;
        let (mut faded, mut before) = (0.0, 0.0);
        let (mut times, mut samples) = (Vec::new(), Vec::new());
        for i in 0..count {
            let time = f64::from(i) / f64::from(count - 1);
            let place = (1.0 - (-3.0 * time).exp()) / (1.0 - (-3.0_f64).exp());
            let approach = 1e-6 * (3.0 * place - 1.0);
            let power = approach.max(0.0).powf(1.5);
            let step = 1.0 / f64::from(count - 1) / 0.15;
            faded = faded * (-step).exp() + (power - before) * (1.0 - (-step).exp()) / step;
            before = power;
            let force = 4.0 / 3.0 * RADIUS.sqrt() * (2e4 * power + 6e4 * faded);
            times.push(time);
            samples.push(Sample {
                approach,
                force: force + 4e-10 * normal(),
            });
        }
        let curve = ForceCurve {
            samples,
            times,
            ..ForceCurve::default()
        };
        has_right_signs("slowing", &curve, false, true);
        is_refused_reversed("slowing", &curve);
    }
}
