//! A baseline that is not level: the slope of the force where nothing acts, as light that interferes on the
//! sample makes it.
//!
//! The slope is one more number of each model's least squares ([`super::estimate`]). Here are its start, and what follows
//! from it.

use std::path::Path;

use super::beam::{Beam, SlopeOf};
use super::choice::{CONTACT_AIC, FitResult, fit_curve};
use super::curve_file::{ForceCurve, Sample};
use super::error::FitError;
use super::estimate::{ModelFit, fit_model};
use super::indenter::Indenter;
use super::measured::{Freedom, Measured};
use super::model::Model;

/// Shares of the points, the farthest apart, of which lines are tried as a start: it is not known how many of them are free.
const FAR: [f64; 4] = [0.05, 0.6, 0.1, 0.3];
/// Difference of Akaike's criterion of fits that have found the same.
const SAME_AIC: f64 = 0.01;
/// Fewest points of such a line.
const LEAST_POINTS: usize = 5;
/// Models that are fitted from each start: without adhesion, and with it.
const TRIED: [Model; 2] = [Model::Hertz, Model::Jkr];

/// Deflection over travel of the base, in contact, below which the noise of the deflection hardly changes the approach.
const GIVES: f64 = 0.1;

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

/// What is taken out of a curve so that its baseline is level.
///
/// Of a curve of positions the slope is by position: a part of the deflection that follows the position, as light that interferes or
/// drift makes it, is in the approach too, and in contact the position moves farther than the probe.
pub(super) struct Tilt<'a> {
    curve: &'a ForceCurve,
    indenter: Indenter,
    freedom: Freedom,
    /// Slope that is taken out, N/m.
    slope: f64,
    by: SlopeBy,
    /// Contact modulus of a quick fit with this slope, by position, and with that of a force, Pa, where the curve does not tell which it has.
    moduli: Option<[f64; 2]>,
}

/// What the slope of a baseline is by.
#[derive(Clone, Copy)]
enum SlopeBy {
    /// The approach; nothing is known of a cantilever.
    Approach,
    /// The position of a cantilever with this spring constant, N/m; where that is at `touch`, m, the approach stays as measured.
    Position { spring: f64, touch: f64 },
    /// The approach, as that of a force of long range, which deflects a cantilever with this spring constant, N/m, and is in no approach.
    Force { spring: f64 },
}

impl<'a> Tilt<'a> {
    /// About the slope of the baseline of a curve; 0 if it is known to be level.
    pub(super) fn of_curve(curve: &'a ForceCurve, indenter: Indenter, freedom: Freedom) -> Self {
        let level = Tilt {
            curve,
            indenter,
            freedom,
            slope: 0.0,
            by: SlopeBy::Approach,
            moduli: None,
        };
        let spring = curve.spring.filter(|_| curve.has_positions);
        if !freedom.baseline_slope {
            return match spring.filter(|spring| gives_way(&curve.samples, *spring)) {
                Some(spring) => Tilt {
                    by: SlopeBy::Position { spring, touch: 0.0 },
                    ..level
                },
                None => level,
            };
        }
        let sloping = |by: SlopeBy, place: &dyn Fn(&Sample) -> f64| {
            let starts = far_slopes(&curve.samples, place);
            best_of(starts.map(|slope| Tilt { slope, by, ..level }))
        };
        let approach = |sample: &Sample| sample.approach;
        let Some(spring) = spring else {
            return sloping(SlopeBy::Approach, &approach).0;
        };
        let position = |sample: &Sample| position(sample, spring);
        let by_position = SlopeBy::Position { spring, touch: 0.0 };
        let (mut by_position, of_position) = sloping(by_position, &position);
        let (by_force, of_force) = sloping(SlopeBy::Force { spring }, &approach);
        let (Some(of_position), Some(of_force)) = (of_position, of_force) else {
            return by_position;
        };
        // A tilt of the deflection is the usual case. Noise alone may favour a force, together with an adhesion that the curve does not have.
        let gain = of_position.aic - of_force.aic;
        if gain > CONTACT_AIC {
            return by_force;
        }
        if gain > -CONTACT_AIC {
            let moduli = [&of_position, &of_force].map(|fit| fit.parameters.contact_modulus);
            by_position.moduli = Some(moduli);
        }
        by_position
    }

    /// A warning where the curve does not tell the two kinds of slopes apart, and the modulus, with this deviation, depends on them.
    pub(super) fn doubt(&self, deviation: Option<f64>) -> Option<String> {
        let [chosen, other] = self.moduli?;
        let is_felt = (other - chosen).abs() > deviation?;
        is_felt.then(|| {
            format!(
                "the curve does not tell whether the slope of its baseline is one of the deflection, which is taken, or that of a force of long range: then E* changes by {:+.1} %",
                100.0 * (other / chosen - 1.0),
            )
        })
    }

    /// The curve with a level baseline.
    pub(super) fn measured(&self) -> Measured {
        let samples = &self.curve.samples;
        let positions = |samples: &[Sample], spring: f64| {
            let each = samples.iter().map(|sample| position(sample, spring));
            each.collect::<Vec<_>>()
        };
        let with_beam = |samples: Vec<Sample>, beam: Option<Beam>| Measured {
            beam,
            ..Measured::new(samples, self.indenter, self.freedom)
        };
        match self.by {
            SlopeBy::Approach => with_beam(without(samples, self.slope), None),
            SlopeBy::Position { spring, touch } => {
                let level = samples.iter().map(|sample| {
                    let position = position(sample, spring);
                    Sample {
                        approach: sample.approach + self.slope * (position - touch) / spring,
                        force: sample.force - self.slope * position,
                    }
                });
                let level: Vec<Sample> = level.collect();
                let beam = Beam {
                    spring,
                    positions: positions(&level, spring),
                    // What is taken out there is out of its position too.
                    slope: SlopeOf::Deflection {
                        touch: touch - self.slope * touch / spring,
                    },
                };
                with_beam(level, Some(beam))
            }
            SlopeBy::Force { spring } => {
                let beam = Beam {
                    spring,
                    positions: positions(samples, spring),
                    slope: SlopeOf::Force { taken: self.slope },
                };
                with_beam(without(samples, self.slope), Some(beam))
            }
        }
    }

    /// Takes the rest of the slope that quick fits find, and the best of them.
    fn refine(&mut self) -> Option<ModelFit> {
        let measured = self.measured();
        let fits = TRIED
            .iter()
            .filter_map(|model| fit_model(&measured, *model));
        let best = fits.min_by(|a, b| a.aic.total_cmp(&b.aic))?;
        let found = best.parameters;
        if let SlopeBy::Position { spring, touch } = &mut self.by {
            // Where approach and force of the baseline are those of first touch.
            let level = found.approach_offset + found.force_offset / *spring;
            let place = level / (1.0 - found.baseline_slope / *spring);
            *touch = place + self.slope * *touch / *spring;
        }
        self.slope += found.baseline_slope;
        Some(best)
    }

    /// Takes the rest of the slope, that of the chosen fit of [`Tilt::measured`], out of the points and out of the forces of all fits. The
    /// slopes of the other fits are then the difference to that of the chosen one.
    pub(super) fn level(
        &mut self,
        measured: &mut Measured,
        fits: &mut [ModelFit],
        chosen: usize,
    ) -> BaselineSlope {
        let best = &fits[chosen];
        let rest = best.parameters.baseline_slope;
        let uncertainty = best.uncertainties.baseline_slope.unwrap_or(f64::NAN);
        let of_slope = |at: usize| rest * measured.place(at);
        for fit in fits {
            fit.parameters.baseline_slope -= rest;
            for (at, force) in fit.fitted.iter_mut().enumerate() {
                *force -= of_slope(at);
            }
        }
        self.slope += rest;
        *measured = self.measured();
        BaselineSlope {
            value: self.slope,
            uncertainty,
        }
    }
}

/// Whether a spring bends by more than [`GIVES`] of the way of its base in contact, so that the noise of its deflection is felt in the approach.
fn gives_way(samples: &[Sample], spring: f64) -> bool {
    let greatest = samples.iter().map(|sample| sample.force);
    let greatest = greatest.fold(f64::NEG_INFINITY, f64::max);
    let pressed = samples
        .iter()
        .filter(|sample| sample.force > 0.5 * greatest);
    let pressed: Vec<Sample> = pressed.copied().collect();
    line(&pressed, &|sample| position(sample, spring)) > GIVES * spring
}

/// Position of the base of a cantilever, m.
fn position(sample: &Sample, spring: f64) -> f64 {
    sample.approach + sample.force / spring
}

/// The tilt of the best quick fit, and that fit. Where two starts have led to the best one no more are tried.
fn best_of<'a>(tilts: [Tilt<'a>; FAR.len()]) -> (Tilt<'a>, Option<ModelFit>) {
    let [first, rest @ ..] = tilts;
    let refined = |mut tilt: Tilt<'a>| {
        let fit = tilt.refine();
        (tilt, fit)
    };
    let misfit = |found: &(Tilt<'a>, Option<ModelFit>)| {
        let fit = found.1.as_ref();
        fit.map_or(f64::INFINITY, |fit| fit.aic)
    };
    let mut best = refined(first);
    for tilt in rest {
        let next = refined(tilt);
        let is_same = (misfit(&next) - misfit(&best)).abs() < SAME_AIC;
        if misfit(&next) < misfit(&best) {
            best = next;
        }
        if is_same {
            break;
        }
    }
    best
}

/// Slopes of lines through the points that are farthest apart, by a place on the curve.
fn far_slopes(samples: &[Sample], place: &dyn Fn(&Sample) -> f64) -> [f64; FAR.len()] {
    let mut far: Vec<Sample> = samples.to_vec();
    far.sort_by(|a, b| a.approach.total_cmp(&b.approach));
    FAR.map(|share| {
        let points = LEAST_POINTS.max((share * far.len() as f64) as usize);
        line(&far[..points.min(far.len())], place)
    })
}

/// The points with a slope by approach taken out.
fn without(samples: &[Sample], slope: f64) -> Vec<Sample> {
    let level = |sample: &Sample| Sample {
        force: sample.force - slope * sample.approach,
        ..*sample
    };
    samples.iter().map(level).collect()
}

/// Slope of the least-squares line of force by place; 0 if all places are the same.
fn line(samples: &[Sample], place: &dyn Fn(&Sample) -> f64) -> f64 {
    let count = samples.len() as f64;
    let mean = |of: &dyn Fn(&Sample) -> f64| samples.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(place), mean(&|s| s.force));
    let spread: f64 = samples.iter().map(|s| (place(s) - x).powi(2)).sum();
    let product = |s: &Sample| (place(s) - x) * (s.force - y);
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
            let curve = sphere(120, 1.2e-7, 100 + seed);
            let mut tilt = Tilt::of_curve(&curve, RADIUS.into(), freedom);
            let mut measured = tilt.measured();
            let mut fits = vec![fit_model(&measured, Model::Hertz).unwrap()];
            let slope = tilt.level(&mut measured, &mut fits, 0);
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
        let measured = Tilt::of_curve(&curve, RADIUS.into(), freedom).measured();
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
