//! States of a model at several lambdas, and what they tell of the uncertainties.

use super::deviations::Uncertainties;
use super::estimate::ModelFit;
use super::model::Parameters;

/// Rise of the sum of squares, in variances of the noise, up to which a state contributes to the
/// uncertainty: three standard deviations.
pub(super) const MOST_RISE: f64 = 9.0;
/// Standard deviation of ln lambda from which a parabola around the minimum is meaningless, and the
/// profile over lambda is used.
const FLAT_PROFILE: f64 = 0.5;

/// The best numbers at one lambda, with standard deviations at that lambda.
#[derive(Clone, Copy, Debug)]
pub(super) struct ProfilePoint {
    pub parameters: Parameters,
    pub uncertainties: Uncertainties,
    /// Sum of squares of the residuals, N^2.
    pub sum_of_squares: f64,
}

impl ProfilePoint {
    /// Standard deviation of a number at `value` implied by this state: a state whose sum of
    /// squares is larger by `rise` variances implies a distance of `sqrt(rise)` deviations, as for
    /// a parabola. `None` if the state is ruled out.
    pub(super) fn deviation(
        &self,
        value: f64,
        number: impl Fn(&Parameters, &Uncertainties) -> (f64, Option<f64>),
        rise: f64,
    ) -> Option<f64> {
        let (other, own) = number(&self.parameters, &self.uncertainties);
        (rise <= MOST_RISE)
            .then(|| ((other - value) / rise.max(1.0).sqrt()).hypot(own.unwrap_or(0.0)))
    }
}

/// Takes the uncertainties from the profile over lambda if lambda is so uncertain that a parabola
/// around the minimum is meaningless.
pub(super) fn widen(fit: &mut ModelFit, radius: Option<f64>) {
    let radius = radius.unwrap_or(f64::NAN);
    let parameters = fit.parameters;
    let known = fit.uncertainties.maugis_parameter;
    let parabola = known.is_some_and(|known| known < FLAT_PROFILE * parameters.maugis_parameter);
    type Pick = fn(&mut Uncertainties) -> &mut Option<f64>;
    type Value = fn(&Parameters, f64) -> f64;
    let numbers: [(Pick, Value); 6] = [
        (|u| &mut u.work_of_adhesion, |p, _| p.work_of_adhesion),
        (|u| &mut u.contact_modulus, |p, _| p.contact_modulus),
        (|u| &mut u.maugis_parameter, |p, _| p.maugis_parameter),
        (|u| &mut u.approach_offset, |p, _| p.approach_offset),
        (
            |u| &mut u.range,
            |p, radius| p.work_of_adhesion / p.peak_tension(radius),
        ),
        (|u| &mut u.peak_tension, |p, radius| p.peak_tension(radius)),
    ];
    for (pick, value) in numbers {
        let spread = fit.profile.iter().filter_map(|point| {
            let rise = (point.sum_of_squares - fit.sum_of_squares) / fit.variance;
            let own = |p: &Parameters, u: &Uncertainties| (value(p, radius), *pick(&mut u.clone()));
            point.deviation(value(&parameters, radius), own, rise)
        });
        let Some(spread) = spread.reduce(f64::max) else {
            continue;
        };
        let deviation = pick(&mut fit.uncertainties);
        // A number that does not affect the curve (a fixed offset, a lambda at its limit) is left
        // as it is.
        *deviation = deviation.map(|known| if parabola { known.max(spread) } else { spread });
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::fit::estimate::fit_model;
    use crate::fit::model::IndenterModel;
    use crate::fit::test_noise::normal;
    use crate::fit::{ForceCurve, Freedom, Measured, Model, Sample, fit_curve};

    const RADIUS: f64 = 1e-6;
    const FREE: Freedom = Freedom {
        approach_offset: true,
        force_offset: false,
        baseline_slope: false,
        range: None,
    };

    fn sphere(lambda: f64) -> Parameters {
        Parameters {
            contact_modulus: 1e7,
            work_of_adhesion: 0.05,
            maugis_parameter: lambda,
            ..Parameters::default()
        }
    }

    /// Loading and unloading of a Maugis-Dugdale sphere, with noise of a share of `pi w R`.
    fn made(truth: &Parameters, noise: f64) -> Vec<Sample> {
        let tip = IndenterModel::new(Model::MaugisDugdale, RADIUS);
        let (force_unit, unit) = tip
            .indenter
            .units(truth.contact_modulus, truth.work_of_adhesion);
        let fold = tip.fold(truth.maugis_parameter).unwrap() * unit;
        let mut normal = normal(1);
        let samples = (0..120).map(|i| {
            let approach = unit * (4.0 - (f64::from(i) - 59.5).abs() / 8.0);
            let jump = if i < 60 { 0.0 } else { fold };
            let force = if approach > jump {
                tip.forces(truth, &[approach]).unwrap()[0]
            } else {
                0.0
            };
            Sample {
                approach,
                force: force + noise * force_unit * normal(),
            }
        });
        samples.collect()
    }

    /// At this noise nothing is known of lambda above 1, and no more of the tension. It was stated up to 67 deviations off.
    #[test]
    fn tension_and_range_are_as_uncertain_as_lambda() {
        let truth = sphere(3.0);
        let measured = Measured::new(made(&truth, 0.05), RADIUS, FREE);
        let fit = fit_model(&measured, Model::MaugisDugdale).unwrap();
        let tension = truth.peak_tension(RADIUS);
        for (found, true_value, deviation) in [
            (
                fit.peak_tension(RADIUS),
                tension,
                fit.uncertainties.peak_tension,
            ),
            (
                fit.range(RADIUS),
                truth.work_of_adhesion / tension,
                fit.uncertainties.range,
            ),
        ] {
            let (found, deviation) = (found.unwrap(), deviation.unwrap());
            assert!(
                (found - true_value).abs() < 3.0 * deviation,
                "{found:e} +- {deviation:e}, {true_value:e}"
            );
        }
    }

    /// JKR is chosen of a curve that does not rule out others, which touch first elsewhere: its own deviation is a tenth of the error.
    #[test]
    fn first_touch_is_as_uncertain_as_the_model() {
        let curve = ForceCurve {
            samples: made(&sphere(1.5), 0.02),
            ..ForceCurve::default()
        };
        let found = fit_curve(&curve, Path::new("made"), RADIUS, FREE).unwrap();
        let best = found.best();
        assert_eq!(best.model, Model::Jkr);
        let deviation = best.uncertainties.approach_offset.unwrap();
        let touch = best.parameters.approach_offset;
        assert!(touch.abs() < 3.0 * deviation, "{touch:e} {deviation:e}");
    }

    /// JKR and DMT, which have no range or one without end, are not among what a curve of a known range leaves open. They were, and
    /// w was stated ten times as uncertain as it scatters.
    #[test]
    fn a_known_range_rules_out_other_models() {
        for lambda in [1.5, 4.0] {
            let truth = sphere(lambda);
            let curve = ForceCurve {
                samples: made(&truth, 0.02),
                ..ForceCurve::default()
            };
            let freedom = Freedom {
                range: Some(truth.work_of_adhesion / truth.peak_tension(RADIUS)),
                ..FREE
            };
            let found = fit_curve(&curve, Path::new("made"), RADIUS, freedom).unwrap();
            let off = found.best().parameters.work_of_adhesion / truth.work_of_adhesion - 1.0;
            let deviation = found.work_uncertainty.unwrap() / truth.work_of_adhesion;
            println!(
                "{lambda}: {off:.4} of {deviation:.4}, {:?}",
                found.best().model
            );
            assert!(off.abs() < 3.0 * deviation, "{lambda}: {off} {deviation}");
            assert!(deviation < 0.01, "{lambda}: {deviation}");
        }
    }
}
