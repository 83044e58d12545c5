//! Standard deviations and correlations of the numbers of a fit, from the covariance of its variables.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::estimate::{Search, Uncertainties, Variable};
use super::model::{LAMBDAS, Model, Parameters};
use super::segments::Segment;

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
    let known = |variance: f64| (variance.is_finite()).then(|| variance.max(0.0).sqrt());
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
    let peak = adhesive.then(|| {
        let modulus = 4.0 * parameters.contact_modulus / 3.0;
        let cube = PI * parameters.work_of_adhesion * modulus * modulus
            / search.tip.indenter.radius().unwrap_or(f64::NAN);
        0.5 * parameters.maugis_parameter * cube.cbrt()
    });
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

/// Correlation of neighbouring residuals, and the variance of the residuals, corrected for it.
pub(super) fn variance_of(
    residuals: &DVector<f64>,
    degrees: usize,
    segments: &[Segment],
) -> (f64, f64) {
    let points = residuals.len() as f64;
    let autocorrelation = autocorrelation(residuals, segments);
    // Correlated residuals count for fewer: n (1 - r)/(1 + r) of them are independent.
    let noticed = autocorrelation > 2.0 / points.sqrt();
    let repeated = if noticed {
        ((1.0 + autocorrelation) / (1.0 - autocorrelation)).min(0.1 * points)
    } else {
        1.0
    };
    let variance = residuals.norm_squared() / degrees as f64 * repeated.max(1.0);
    (autocorrelation, variance)
}

/// Correlation of each residual with the next one of the same segment.
fn autocorrelation(residuals: &DVector<f64>, segments: &[Segment]) -> f64 {
    let square = residuals.norm_squared();
    let products: f64 = segments
        .iter()
        .flat_map(|segment| segment.points.clone().skip(1))
        .map(|i| residuals[i] * residuals[i - 1])
        .sum();
    if square > 0.0 {
        (products / square).clamp(-0.99, 0.99)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

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
        let freedom = Freedom {
            approach_offset: false,
            force_offset: false,
            baseline_slope: false,
            range: None,
        };
        let result = fit_curve(&curve, Path::new("mixed"), 1e-5, freedom).unwrap();
        assert!(!result.describes_curve);
        let is_said = |warning: &String| warning.contains("seem to be mixed");
        assert!(result.warnings.iter().any(is_said), "{:?}", result.warnings);
    }
}
