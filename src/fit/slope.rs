//! A baseline that is not level: the slope of the force where nothing acts, as light that interferes on the
//! sample makes it.
//!
//! The slope is one more number of each model's least squares ([`super::estimate`]). Here are its start, and what follows
//! from it.

use std::path::Path;

use super::choice::{FitResult, fit_curve};
use super::curve_file::{ForceCurve, Sample};
use super::error::FitError;
use super::estimate::{ModelFit, fit_model};
use super::indenter::Indenter;
use super::measured::{Freedom, Measured};
use super::model::Model;

/// Shares of the points, the farthest apart, of which lines are tried as a start: it is not known how many of them are free.
const FAR: [f64; 4] = [0.05, 0.1, 0.3, 0.6];
/// Fewest points of such a line.
const LEAST_POINTS: usize = 5;
/// Models that are fitted from each start: without adhesion, and with it.
const TRIED: [Model; 2] = [Model::Hertz, Model::Jkr];
/// Times that the slope is found of a curve of positions, whose approaches change with it.
const ROUNDS: usize = 3;

/// Slope of the baseline.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BaselineSlope {
    /// Force over approach, or over position where that was measured, N/m.
    pub value: f64,
    /// Its standard deviation, N/m; NaN where the curve does not determine it.
    pub uncertainty: f64,
}

/// Fits a curve whose baseline has an offset and a slope. The result's curve has the slope taken out, so that it is
/// level where the sphere is free; its offset is that at approach 0.
///
/// # Errors
/// As [`fit_curve`]; too few points where no force acts.
pub fn fit_with_slope(
    curve: &ForceCurve,
    path: &Path,
    indenter: impl Into<Indenter>,
    freedom: Freedom,
) -> Result<FitResult, FitError> {
    let freedom = Freedom {
        force_offset: true,
        baseline_slope: true,
        ..freedom
    };
    fit_curve(curve, path, indenter, freedom)
}

/// The points with about the slope of their baseline taken out, and that slope, N/m; 0 if it is known to be level.
///
/// Of a curve of positions the slope is by position: a part of the deflection that follows the position, as light that interferes or
/// drift makes it, is in the approach too, and in contact the position moves farther than the probe.
pub(super) fn about_level(
    curve: &ForceCurve,
    indenter: Indenter,
    freedom: Freedom,
) -> (Vec<Sample>, f64) {
    if !freedom.baseline_slope {
        return (curve.samples.clone(), 0.0);
    }
    let (slope, touch, misfit) = first(&curve.samples, indenter, freedom);
    let Some(spring) = curve.spring.filter(|_| curve.has_positions) else {
        return (without(&curve.samples, slope), slope);
    };
    let by_position = |slope: f64| slope / (1.0 + slope / spring);
    // The approach of first touch stays as measured.
    let touch = touch.approach + touch.force / spring;
    let mut tilt = by_position(slope);
    for _ in 1..ROUNDS {
        let samples = without_tilt(&curve.samples, tilt, spring, touch);
        tilt += by_position(first(&samples, indenter, freedom).0);
    }
    let samples = without_tilt(&curve.samples, tilt, spring, touch);
    // A force of long range that deflects the cantilever is in no approach: what describes the curve better is taken.
    if first(&samples, indenter, freedom).2 < misfit {
        (samples, tilt)
    } else {
        (without(&curve.samples, slope), slope)
    }
}

/// The points without the part of their forces that is `tilt` (N/m) times the position of the base of the cantilever, in their
/// approaches too; these stay at the position `touch`.
fn without_tilt(samples: &[Sample], tilt: f64, spring: f64, touch: f64) -> Vec<Sample> {
    let level = |sample: &Sample| {
        let position = sample.approach + sample.force / spring;
        Sample {
            approach: sample.approach + tilt * (position - touch) / spring,
            force: sample.force - tilt * position,
        }
    };
    samples.iter().map(level).collect()
}

/// About the slope of the baseline, N/m, approach and force of first touch, and the sum of squares, N^2: of the best of quick fits with
/// a slope.
fn first(samples: &[Sample], indenter: Indenter, freedom: Freedom) -> (f64, Sample, f64) {
    let mut far = samples.to_vec();
    far.sort_by(|a, b| a.approach.total_cmp(&b.approach));
    let slopes = FAR.map(|share| {
        let points = LEAST_POINTS.max((share * far.len() as f64) as usize);
        line(&far[..points.min(far.len())])
    });
    let fits = slopes.iter().flat_map(|slope| {
        let measured = Measured::new(without(samples, *slope), indenter, freedom);
        TRIED.map(|model| {
            let fit = fit_model(&measured, model)?;
            let (found, slope) = (fit.parameters, slope + fit.parameters.baseline_slope);
            let approach = found.approach_offset;
            let touch = Sample {
                approach,
                force: found.force_offset + slope * approach,
            };
            Some((slope, touch, fit.sum_of_squares))
        })
    });
    let best = fits.flatten().min_by(|a, b| a.2.total_cmp(&b.2));
    best.unwrap_or((slopes[0], samples[0], f64::INFINITY))
}

/// The points with a slope taken out.
fn without(samples: &[Sample], slope: f64) -> Vec<Sample> {
    let level = |sample: &Sample| Sample {
        force: sample.force - slope * sample.approach,
        ..*sample
    };
    samples.iter().map(level).collect()
}

/// Takes the rest of the slope, that of the chosen fit, out of the points and out of the forces of all fits; `first` is
/// the part that was taken out before. The slopes of the other fits are then the difference to that of the chosen one.
pub(super) fn level(
    measured: &mut Measured,
    fits: &mut [ModelFit],
    chosen: usize,
    first: f64,
) -> BaselineSlope {
    let best = &fits[chosen];
    let rest = best.parameters.baseline_slope;
    let uncertainty = best.uncertainties.baseline_slope.unwrap_or(f64::NAN);
    for fit in fits {
        fit.parameters.baseline_slope -= rest;
        for (force, approach) in fit.fitted.iter_mut().zip(&measured.approaches) {
            *force -= rest * approach;
        }
    }
    let samples = without(&measured.samples, rest);
    *measured = Measured::new(samples, measured.indenter, measured.freedom);
    BaselineSlope {
        value: first + rest,
        uncertainty,
    }
}

/// Slope of the least-squares line of force by approach; 0 if all approaches are the same.
fn line(samples: &[Sample]) -> f64 {
    let count = samples.len() as f64;
    let mean = |of: &dyn Fn(&Sample) -> f64| samples.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(&|s| s.approach), mean(&|s| s.force));
    let spread: f64 = samples.iter().map(|s| (s.approach - x).powi(2)).sum();
    let product = |s: &Sample| (s.approach - x) * (s.force - y);
    if spread > 0.0 {
        samples.iter().map(product).sum::<f64>() / spread
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::test_noise::normal;

    const RADIUS: f64 = 10e-6;
    const MODULUS: f64 = 1e6;
    const SLOPE: f64 = 0.3;
    const OFFSET: f64 = 1e-6;

    /// A Hertz sphere that is free at one point in eight, on a tilted baseline, with noise in N.
    fn sphere(points: u32, noise: f64, seed: u64) -> ForceCurve {
        let mut normal = normal(seed);
        let samples = (0..points).map(|i| {
            let approach = 2e-6 - 2.3e-6 * f64::from(i) / f64::from(points - 1);
            let hertz = 4.0 / 3.0 * MODULUS * RADIUS.sqrt() * approach.max(0.0).powf(1.5);
            Sample {
                approach,
                force: hertz + OFFSET + SLOPE * approach + noise * normal(),
            }
        });
        ForceCurve {
            samples: samples.collect(),
            ..ForceCurve::default()
        }
    }

    /// Where few points are free the slope, the offset and the modulus are known together only, and each uncertainty is that of its scatter.
    /// Lines and fits in turn were up to 37 deviations off.
    #[test]
    fn few_free_points_give_numbers_within_their_uncertainties() {
        let seeds = 12_u64;
        let freedom = Freedom {
            approach_offset: true,
            force_offset: true,
            baseline_slope: true,
            range: None,
        };
        let mut squares = [0.0; 4];
        for seed in 0..seeds {
            let samples = sphere(120, 1.2e-7, 100 + seed).samples;
            let (tilt, ..) = first(&samples, RADIUS.into(), freedom);
            let mut measured = Measured::new(without(&samples, tilt), RADIUS, freedom);
            let mut fits = vec![fit_model(&measured, Model::Hertz).unwrap()];
            let slope = level(&mut measured, &mut fits, 0, tilt);
            let (found, stated) = (&fits[0].parameters, &fits[0].uncertainties);
            assert_eq!(found.baseline_slope, 0.0);
            let numbers = [
                (found.contact_modulus - MODULUS, stated.contact_modulus),
                (found.approach_offset, stated.approach_offset),
                (found.force_offset - OFFSET, stated.force_offset),
                (slope.value - SLOPE, Some(slope.uncertainty)),
            ];
            for (square, (error, deviation)) in squares.iter_mut().zip(numbers) {
                *square += (error / deviation.unwrap()).powi(2);
            }
        }
        for square in squares {
            // The sum of 12 squares of normal numbers is 2.2 to 35 in 999 cases of 1000. A joint fit by another program (scipy's
            // curve_fit) of these curves has 20.6, 28.3, 24.5 and 24.7; of 300 such curves its root is 1.02 to 1.05.
            let rms = (square / seeds as f64).sqrt();
            assert!((0.43..1.71).contains(&rms), "{squares:?}");
        }
    }

    /// Far from approach 0 the baseline there has the uncertainty of the slope times the distance.
    #[test]
    fn the_offset_at_a_distant_zero_has_the_uncertainty_of_the_slope() {
        let shift = 1e-4;
        let mut curve = sphere(120, 1.2e-7, 3);
        for sample in &mut curve.samples {
            sample.approach += shift;
        }
        let freedom = Freedom {
            approach_offset: true,
            force_offset: true,
            baseline_slope: true,
            range: None,
        };
        let (tilt, ..) = first(&curve.samples, RADIUS.into(), freedom);
        let measured = Measured::new(without(&curve.samples, tilt), RADIUS, freedom);
        let stated = fit_model(&measured, Model::Hertz).unwrap().uncertainties;
        let expected = shift * stated.baseline_slope.unwrap();
        let found = stated.force_offset.unwrap();
        // The middle of the curve lies 2 % off, its own offset adds less.
        assert!(
            (found / expected - 1.0).abs() < 0.05,
            "{found:e} {expected:e}"
        );
    }
}
