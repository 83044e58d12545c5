//! A baseline that is not level: the slope of the force where nothing acts, as light that interferes on the
//! sample makes it.

use std::path::Path;

use super::choice::{FitResult, fit_curve};
use super::curve_file::{ForceCurve, Sample};
use super::error::FitError;
use super::indenter::Indenter;
use super::measured::Freedom;

/// Share of the points, the farthest apart, that the first estimate is made of.
const FAR: f64 = 0.3;
/// Fewest free points of a slope.
const LEAST_POINTS: usize = 5;
/// Most fits. The free points of the second are nearly always those of the first.
const ROUNDS: usize = 4;
/// Change of the slope, in its standard deviations, from which on another fit would say the same.
const SAME: f64 = 0.05;

/// Slope of the baseline.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BaselineSlope {
    /// Force over approach, N/m.
    pub value: f64,
    /// Its standard deviation, N/m.
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
        ..freedom
    };
    let indenter = indenter.into();
    let mut far: Vec<Sample> = curve.samples.clone();
    far.sort_by(|a, b| a.approach.total_cmp(&b.approach));
    far.truncate(LEAST_POINTS.max((FAR * far.len() as f64) as usize));
    let mut slope = line(&far);
    let mut round = 1;
    loop {
        let level = |sample: &Sample| Sample {
            force: sample.force - slope.value * sample.approach,
            ..*sample
        };
        let levelled = ForceCurve {
            samples: curve.samples.iter().map(level).collect(),
            ..curve.clone()
        };
        let mut result = fit_curve(&levelled, path, indenter, freedom)?;
        let free: Vec<Sample> = free(&result).map(|at| curve.samples[at]).collect();
        if free.len() < LEAST_POINTS {
            return Err(FitError::NoBaseline {
                path: path.display().to_string(),
                points: free.len(),
            });
        }
        let next = line(&free);
        if round == ROUNDS || (next.value - slope.value).abs() <= SAME * next.uncertainty {
            result.baseline_slope = Some(BaselineSlope {
                value: slope.value,
                ..next
            });
            return Ok(result);
        }
        slope = next;
        round += 1;
    }
}

/// The points where the sphere is free.
fn free(result: &FitResult) -> impl Iterator<Item = usize> {
    let best = result.best();
    let touch = best.parameters.approach_offset;
    (0..result.measured.samples.len()).filter(move |at| {
        !best.interacting[*at]
            || (!best.model.adheres() && result.measured.samples[*at].approach < touch)
    })
}

/// The least-squares line of force by approach.
fn line(samples: &[Sample]) -> BaselineSlope {
    let count = samples.len() as f64;
    let mean = |of: &dyn Fn(&Sample) -> f64| samples.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(&|s| s.approach), mean(&|s| s.force));
    let spread: f64 = samples.iter().map(|s| (s.approach - x).powi(2)).sum();
    let product = |s: &Sample| (s.approach - x) * (s.force - y);
    let value = if spread > 0.0 {
        samples.iter().map(product).sum::<f64>() / spread
    } else {
        0.0
    };
    let residual = |s: &Sample| s.force - y - value * (s.approach - x);
    let squares: f64 = samples.iter().map(|s| residual(s).powi(2)).sum();
    let uncertainty = (squares / (count - 2.0).max(1.0) / spread).sqrt();
    BaselineSlope {
        value,
        uncertainty: if uncertainty.is_finite() {
            uncertainty
        } else {
            0.0
        },
    }
}
