//! Standard deviations and correlations of the numbers of a fit, from the covariance of its variables.

use nalgebra::DMatrix;

use super::model::{LAMBDAS, Model, Parameters};
use super::search::{Search, Variable};

/// Rounding that a correlation of 1 may have.
const ROUNDING: f64 = 1e-6;

/// Uncertainties: one standard deviation each, `None` if the curve does not determine the number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Uncertainties {
    /// Of E*, Pa.
    pub contact_modulus: Option<f64>,
    /// Of w, J/m^2.
    pub work_of_adhesion: Option<f64>,
    /// Of lambda.
    pub maugis_parameter: Option<f64>,
    /// Of the range, w over the tension, m.
    pub range: Option<f64>,
    /// Of the tension of the cohesive zone, Pa.
    pub peak_tension: Option<f64>,
    /// Of the approach at first touch, m.
    pub approach_offset: Option<f64>,
    /// Of the baseline force, N.
    pub force_offset: Option<f64>,
    /// Of the slope of the baseline, N/m.
    pub baseline_slope: Option<f64>,
}

/// Covariance of the force and the slope of the baseline, with the force at the middle of the curve: from that at approach 0,
/// which may lie far away, digits would cancel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BaselineError {
    /// Approach of the middle, m.
    middle: f64,
    /// Variance of the force there, N^2; NaN where the curve does not determine it, as in the next.
    force: f64,
    /// Covariance of force and slope, N^2/m.
    both: f64,
    /// Variance of the slope, N^2/m^2.
    slope: f64,
}

impl BaselineError {
    /// From a covariance about the middle of the curve; what is not fitted has no error.
    pub(super) fn new(search: &Search, by_middle: &DMatrix<f64>) -> Self {
        let place = |variable: Variable| search.variables.iter().position(|v| *v == variable);
        let part = |first: Variable, second: Variable| match (place(first), place(second)) {
            (Some(i), Some(j)) => by_middle[(i, j)] * search.unit(first) * search.unit(second),
            _ => 0.0,
        };
        use Variable::{BaselineSlope, ForceOffset};
        BaselineError {
            middle: search.measured.middle,
            force: part(ForceOffset, ForceOffset),
            both: part(ForceOffset, BaselineSlope),
            slope: part(BaselineSlope, BaselineSlope),
        }
    }

    /// Standard deviation of the force of the baseline at an approach, N.
    pub(super) fn of_force(&self, approach: f64) -> f64 {
        let from_middle = approach - self.middle;
        (self.force + from_middle * (2.0 * self.both + from_middle * self.slope)).sqrt()
    }

    /// Standard deviation of the slope, N/m.
    pub(super) fn of_slope(&self) -> f64 {
        self.slope.sqrt()
    }
}

/// A covariance, or NaN throughout where its numbers contradict each other: the inverse of a nearly singular matrix is rounding
/// alone.
pub(super) fn credible(covariance: DMatrix<f64>) -> DMatrix<f64> {
    let count = covariance.ncols();
    let mut is_credible = true;
    for i in 0..count {
        for j in 0..=i {
            let product = covariance[(i, i)] * covariance[(j, j)];
            let most = (1.0 + ROUNDING).powi(2) * product;
            // Numbers without effect are NaN, and no contradiction.
            is_credible &= !(covariance[(i, i)] < 0.0 || covariance[(i, j)].powi(2) > most);
        }
    }
    if is_credible {
        covariance
    } else {
        DMatrix::from_element(count, count, f64::NAN)
    }
}

/// A covariance with the baseline force at approach 0 in place of that at the middle of the curve, about which the search
/// tilts it.
pub(super) fn at_zero(search: &Search, covariance: DMatrix<f64>) -> DMatrix<f64> {
    let place = |variable: Variable| search.variables.iter().position(|v| *v == variable);
    let (Some(offset), Some(slope)) =
        (place(Variable::ForceOffset), place(Variable::BaselineSlope))
    else {
        return covariance;
    };
    let units = search.unit(Variable::BaselineSlope) / search.unit(Variable::ForceOffset);
    let count = covariance.ncols();
    let mut by_middle = DMatrix::identity(count, count);
    by_middle[(offset, slope)] = -units * search.measured.middle;
    // Numbers without effect have no covariance; they take no part.
    let felt: Vec<usize> = (0..count)
        .filter(|i| covariance[(*i, *i)].is_finite())
        .collect();
    let known = covariance.select_rows(&felt).select_columns(&felt);
    let by_middle = by_middle.select_rows(&felt).select_columns(&felt);
    let moved = &by_middle * known * by_middle.transpose();
    let mut result = covariance;
    for (i, row) in felt.iter().enumerate() {
        for (j, column) in felt.iter().enumerate() {
            result[(*row, *column)] = moved[(i, j)];
        }
    }
    result
}

/// Standard deviations of the numbers of a fit.
pub(super) fn uncertainties(
    search: &Search,
    parameters: &Parameters,
    covariance: &DMatrix<f64>,
) -> Uncertainties {
    let place = |variable: Variable| search.variables.iter().position(|v| *v == variable);
    // A negative variance is rounding alone.
    let known = |variance: f64| (variance.is_finite() && variance >= 0.0).then(|| variance.sqrt());
    // Standard deviation of a linear combination of variables.
    let of = |weights: &[(Variable, f64)]| -> Option<f64> {
        let mut variance = 0.0;
        for (first, a) in weights {
            for (second, b) in weights {
                let (i, j) = (place(*first)?, place(*second)?);
                variance += a * b * covariance[(i, j)];
            }
        }
        known(variance)
    };
    let alone = |variable| of(&[(variable, 1.0)]);
    let scaled = |deviation: Option<f64>, by: Option<f64>| Some(deviation? * by?);
    let model = search.tip.model;
    // ln tension = ln lambda + (1/3) ln w + (2/3) ln E*, and the range is w over it.
    use Variable::{
        ApproachOffset, BaselineSlope, ContactModulus, ForceOffset, MaugisParameter, WorkOfAdhesion,
    };
    let third = 1.0 / 3.0;
    let lambda = parameters.maugis_parameter;
    let bounded = lambda <= LAMBDAS.0 || lambda >= LAMBDAS.1;
    let within = |deviation: Option<f64>| deviation.filter(|_| !bounded);
    let tension = of(&[
        (MaugisParameter, 1.0),
        (WorkOfAdhesion, third),
        (ContactModulus, 2.0 * third),
    ]);
    let range = of(&[
        (MaugisParameter, -1.0),
        (WorkOfAdhesion, 2.0 * third),
        (ContactModulus, -2.0 * third),
    ]);
    let adhesive = model == Model::MaugisDugdale;
    let radius = search.tip.indenter.radius().unwrap_or(f64::NAN);
    let peak = adhesive.then(|| parameters.peak_tension(radius));
    let reach = peak.map(|peak| parameters.work_of_adhesion / peak);
    Uncertainties {
        contact_modulus: scaled(alone(ContactModulus), Some(parameters.contact_modulus)),
        work_of_adhesion: scaled(alone(WorkOfAdhesion), Some(parameters.work_of_adhesion)),
        maugis_parameter: scaled(within(alone(MaugisParameter)), Some(lambda)),
        range: scaled(within(range), reach),
        peak_tension: scaled(within(tension), peak),
        approach_offset: scaled(alone(ApproachOffset), Some(search.unit(ApproachOffset))),
        force_offset: scaled(alone(ForceOffset), Some(search.unit(ForceOffset))),
        baseline_slope: scaled(alone(BaselineSlope), Some(search.unit(BaselineSlope))),
    }
}

/// Correlations of pairs of variables.
pub(super) fn correlations(
    variables: &[Variable],
    covariance: &DMatrix<f64>,
) -> Vec<(&'static str, &'static str, f64)> {
    let mut pairs = Vec::new();
    for i in 0..variables.len() {
        for j in i + 1..variables.len() {
            let product = covariance[(i, i)] * covariance[(j, j)];
            let correlation = covariance[(i, j)] / product.sqrt();
            if correlation.is_finite() {
                pairs.push((variables[i].name(), variables[j].name(), correlation));
            }
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::fit::{ForceCurve, Freedom, Sample, fit_curve};

    /// Extension and retraction differ by the drag of a liquid and are sorted by approach: each residual is the opposite of the next.
    #[test]
    fn mixed_rows_are_no_curve() {
        let sample = |i: u32| {
            let approach = 1e-6 * (f64::from(i) / 79.0 - 0.3);
            let hertz = 4.0 / 3.0 * 1e6 * 1e-5_f64.sqrt() * approach.max(0.0).powf(1.5);
            let side = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            Sample {
                approach,
                force: hertz + 1e-8 * side,
            }
        };
        let curve = ForceCurve {
            samples: (0..80).map(sample).collect(),
            ..ForceCurve::default()
        };
        let result = fit_curve(&curve, Path::new("mixed"), 1e-5, Freedom::default()).unwrap();
        assert!(!result.describes_curve);
        let is_said = |warning: &String| warning.contains("seem to be mixed");
        assert!(result.warnings.iter().any(is_said), "{:?}", result.warnings);
    }

    /// Force 1 +- 0.2 and slope 3 +- 0.4 with a correlation of 0.5: a step of 2 away the variance is 0.04 + 4 * 0.04 + 4 * 0.16.
    #[test]
    fn a_baseline_is_less_certain_away_from_the_middle() {
        let error = BaselineError {
            middle: 5.0,
            force: 0.04,
            both: 0.04,
            slope: 0.16,
        };
        approx::assert_relative_eq!(error.of_force(5.0), 0.2, max_relative = 1e-12);
        approx::assert_relative_eq!(error.of_force(7.0), 0.84_f64.sqrt(), max_relative = 1e-12);
        approx::assert_relative_eq!(error.of_slope(), 0.4, max_relative = 1e-12);
    }

    #[test]
    fn a_covariance_that_contradicts_itself_is_unknown() {
        let two = |a, b, c| DMatrix::from_row_slice(2, 2, &[a, b, b, c]);
        for fine in [two(4.0, -6.0, 9.0), two(0.0, 0.0, 1.0)] {
            assert_eq!(credible(fine.clone()), fine);
        }
        // A number without effect leaves the other as it is.
        assert_eq!(credible(two(4.0, f64::NAN, f64::NAN))[(0, 0)], 4.0);
        for broken in [two(4.0, 6.1, 9.0), two(-1.0, 0.0, 1.0), two(0.0, 1.0, 1.0)] {
            assert!(credible(broken).iter().all(|value| value.is_nan()));
        }
    }

    /// Two approaches determine two numbers at most: nothing is known of the rest. A correlation of -2.4e15 and w within
    /// 1.8 MJ/m^2 were stated.
    #[test]
    fn two_approaches_state_no_deviations() {
        let samples = (0..60).map(|i| Sample {
            approach: if i < 30 { 1e-6 } else { -1e-6 },
            force: 1.2e-5 * (1.0 - f64::from(i) / 40.0).max(0.0).powf(1.5),
        });
        let curve = ForceCurve {
            samples: samples.collect(),
            ..ForceCurve::default()
        };
        let freedom = Freedom {
            approach_offset: true,
            force_offset: true,
            baseline_slope: true,
            range: None,
        };
        let result = fit_curve(&curve, Path::new("same"), 1e-5, freedom).unwrap();
        assert_eq!(result.work_uncertainty, None);
        assert_eq!(result.modulus_uncertainty, None);
        for fit in &result.fits {
            for (first, second, correlation) in &fit.correlations {
                assert!(
                    correlation.abs() < 1.0 + 1e-3,
                    "{first} {second} {correlation}"
                );
            }
        }
    }
}
