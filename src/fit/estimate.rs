//! Fits one model to a curve: its numbers and their uncertainties.

use nalgebra::DVector;

use super::akaike::{aic, transitions};
use super::deviations::{
    BaselineError, Uncertainties, at_zero, correlations, credible, uncertainties,
};
use super::least_squares::{Minimum, Problem, covariance, minimise};
use super::measured::Measured;
use super::model::{IndenterModel, LAMBDAS, Model, Parameters};
use super::profile::{MOST_RISE, ProfilePoint, widen};
use super::scatter::{InContact, Scatter};
use super::search::{Search, Variable};
use super::start::{beside_the_fold, scale_grid, starts};
use crate::theory::tabor_map::LAMBDA_PER_MU_MATCHED;

/// Maugis parameters at which all other numbers are fitted before lambda is freed: the sum of
/// squares has more than one minimum along lambda.
const LAMBDAS_TRIED: [f64; 16] = [
    0.01, 0.03, 0.06, 0.1, 0.16, 0.25, 0.4, 0.6, 0.85, 1.2, 1.7, 2.5, 4.0, 6.5, 11.0, 20.0,
];
/// Number of lambdas from which lambda is freed.
const BEST_LAMBDAS: usize = 3;
/// Points of the grid of scales from which a search starts, in addition to the usual starts.
const GRID_STARTS: usize = 3;
/// Most moves from one basin to the next, and the share by which the next must lie lower.
const MOST_BASINS: usize = 8;
const LOWER: f64 = 1e-6;
/// Share of the greatest dependence on the modulus below which a force has none but for rounding.
const ROUNDED_SLOPE: f64 = 1e-6;
/// Least sum of squares with which a fit is credited, in squares of the force range a point. Below
/// it are rounding and interpolation errors.
const FLOOR: f64 = 1e-14;

/// A model with its best-fitting numbers.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ModelFit {
    /// Which model.
    pub model: Model,
    /// Its numbers.
    pub parameters: Parameters,
    /// Their standard deviations.
    pub uncertainties: Uncertainties,
    /// Correlations of pairs of free numbers.
    pub correlations: Vec<(&'static str, &'static str, f64)>,
    /// Whether the search converged.
    pub converged: bool,
    /// Sum of squares of the residuals, N^2.
    pub sum_of_squares: f64,
    /// Degrees of freedom: points less free numbers.
    pub degrees_of_freedom: usize,
    /// Free numbers.
    pub free: usize,
    /// Akaike's criterion for noise of unknown size; less is better.
    pub aic: f64,
    /// Standard deviation of the residuals, N.
    pub noise: f64,
    /// Correlation of a residual with the next: about 0 for noise, near 1 for a wrong model.
    pub autocorrelation: f64,
    /// Residuals of the points in contact alone, over the range of the forces; `None` where these are few.
    pub(super) in_contact: Option<InContact>,
    /// Force of the model at each point, N.
    pub fitted: Vec<f64>,
    /// For each point, whether the tip interacts with the flat; else it is free.
    pub interacting: Vec<bool>,
    /// Other states of the model, each with the least sum of squares at its lambda.
    pub(super) profile: Vec<ProfilePoint>,
    /// Errors of the fitted baseline.
    pub(super) baseline_error: BaselineError,
    /// Variance of the residuals, corrected for their correlation, N^2.
    pub(super) variance: f64,
}

impl ModelFit {
    /// Correlation of a residual with the next, of the points in contact alone: those whose force depends on the modulus; `None` where these are few.
    pub fn contact_autocorrelation(&self) -> Option<f64> {
        Some(self.in_contact?.autocorrelation)
    }

    /// States of the model that the curve may not rule out: its states over lambda, or the fit
    /// itself if lambda is known more closely than their spacing.
    pub(super) fn states(&self) -> Vec<ProfilePoint> {
        let suits = |point: &&ProfilePoint| {
            point.sum_of_squares - self.sum_of_squares <= MOST_RISE * self.variance
        };
        let profile: Vec<ProfilePoint> = self.profile.iter().filter(suits).copied().collect();
        if profile.is_empty() {
            vec![self.as_profile_point()]
        } else {
            profile
        }
    }

    /// The fit as a state of its own lambda.
    fn as_profile_point(&self) -> ProfilePoint {
        ProfilePoint {
            parameters: self.parameters,
            uncertainties: self.uncertainties,
            sum_of_squares: self.sum_of_squares,
        }
    }

    /// Range of the attraction, m; `None` but for Maugis-Dugdale.
    pub fn range(&self, radius: f64) -> Option<f64> {
        Some(self.parameters.work_of_adhesion / self.peak_tension(radius)?)
    }

    /// Tension of the cohesive zone, Pa; `None` but for Maugis-Dugdale.
    pub fn peak_tension(&self, radius: f64) -> Option<f64> {
        (self.model == Model::MaugisDugdale).then(|| self.parameters.peak_tension(radius))
    }

    /// Whether lambda reached the limit of its range, so that only a bound is known.
    pub fn at_bound(&self) -> bool {
        let lambda = self.parameters.maugis_parameter;
        self.model == Model::MaugisDugdale
            && !(1.01 * LAMBDAS.0..=0.99 * LAMBDAS.1).contains(&lambda)
    }

    /// Tabor number matched to a law of the same work and peak tension.
    pub fn tabor_parameter(&self) -> Option<f64> {
        let known = self.model == Model::MaugisDugdale;
        known.then_some(self.parameters.maugis_parameter / LAMBDA_PER_MU_MATCHED)
    }
}

/// The best fit of a model from several starts; `None` if all of them fail.
pub(super) fn fit_model(measured: &Measured, model: Model) -> Option<ModelFit> {
    let freedom = measured.freedom;
    let mut variables = vec![Variable::ContactModulus];
    if model.adheres() {
        variables.push(Variable::WorkOfAdhesion);
    }
    if model == Model::MaugisDugdale && freedom.range.is_none() {
        variables.push(Variable::MaugisParameter);
    }
    if freedom.approach_offset {
        variables.push(Variable::ApproachOffset);
    }
    if freedom.force_offset {
        variables.push(Variable::ForceOffset);
    }
    if freedom.baseline_slope {
        variables.push(Variable::BaselineSlope);
    }
    let tip = IndenterModel::new(model, measured.indenter);
    let search_from = |start: Parameters, variables: &[Variable]| {
        let search = Search {
            measured,
            tip: &tip,
            variables: variables.to_vec(),
            start,
        };
        let found = minimise(&search, DVector::zeros(variables.len()))?;
        found.sum().is_finite().then_some((found, search))
    };
    let least_of = |starts: Vec<Parameters>, variables: &[Variable]| {
        starts
            .into_iter()
            .filter_map(|start| search_from(start, variables))
            .min_by(|a, b| a.0.sum().total_cmp(&b.0.sum()))
    };
    let best_of = |starts: Vec<Parameters>, variables: &[Variable]| {
        let mut best = least_of(starts, variables)?;
        for _ in 0..MOST_BASINS {
            let here = best.1.parameters(&best.0.variables);
            let beside = least_of(beside_the_fold(measured, &tip, &here), variables);
            match beside.filter(|next| next.0.sum() < (1.0 - LOWER) * best.0.sum()) {
                Some(next) => best = next,
                None => break,
            }
        }
        Some(best)
    };
    let starts_at = |lambda: f64, variables: &[Variable]| {
        let mut starts = starts(measured, &tip, lambda);
        if model.adheres() {
            starts.extend(best_of_grid(measured, &tip, lambda, variables));
        }
        starts
    };
    if !variables.contains(&Variable::MaugisParameter) {
        let (minimum, search) = best_of(starts_at(1.0, &variables), &variables)?;
        return Some(fit_at(&search, &minimum));
    }
    let at_fixed_lambda: Vec<Variable> = variables
        .iter()
        .copied()
        .filter(|variable| *variable != Variable::MaugisParameter)
        .collect();
    let mut profile: Vec<ProfilePoint> = LAMBDAS_TRIED
        .into_iter()
        .filter_map(|lambda| best_of(starts_at(lambda, &at_fixed_lambda), &at_fixed_lambda))
        .map(|(minimum, search)| fit_at(&search, &minimum).as_profile_point())
        .collect();
    profile.sort_by(|a, b| a.sum_of_squares.total_cmp(&b.sum_of_squares));
    let first = profile
        .iter()
        .take(BEST_LAMBDAS)
        .map(|point| point.parameters);
    let (minimum, search) = best_of(first.collect(), &variables)?;
    let mut fit = fit_at(&search, &minimum);
    fit.profile = profile;
    widen(&mut fit, measured.indenter.radius());
    Some(fit)
}

/// The points of the grid of scales with the least sums of squares.
fn best_of_grid(
    measured: &Measured,
    tip: &IndenterModel,
    lambda: f64,
    variables: &[Variable],
) -> Vec<Parameters> {
    let grid = scale_grid(measured, tip, lambda);
    let mut search = Search {
        measured,
        tip,
        variables: variables.to_vec(),
        start: Parameters::default(),
    };
    let here = DVector::zeros(variables.len());
    let mut fit_at: Vec<(f64, Parameters)> = grid
        .into_iter()
        .filter_map(|start| {
            search.start = start;
            let (_, residuals) = search.choose(&here)?;
            let sum = residuals.norm_squared();
            sum.is_finite().then_some((sum, start))
        })
        .collect();
    fit_at.sort_by(|a, b| a.0.total_cmp(&b.0));
    fit_at.truncate(GRID_STARTS);
    fit_at.into_iter().map(|(_, start)| start).collect()
}

/// For each point, whether its force depends on the modulus. That of an adhesive tip with hardly any adhesion interacts everywhere.
fn depends_on_modulus(search: &Search, minimum: &Minimum) -> Vec<bool> {
    let at = search
        .variables
        .iter()
        .position(|v| *v == Variable::ContactModulus);
    let Some(at) = at else {
        return Vec::new();
    };
    let slopes = minimum.jacobian.column(at);
    let least = ROUNDED_SLOPE * slopes.amax();
    slopes.iter().map(|slope| slope.abs() > least).collect()
}

/// Numbers and their uncertainties at a minimum.
fn fit_at(search: &Search, minimum: &Minimum) -> ModelFit {
    let measured = search.measured;
    let parameters = search.parameters(&minimum.variables);
    let points = measured.samples.len();
    let free = search.variables.len();
    let degrees = points.saturating_sub(free).max(1);
    let sum = minimum.sum();
    let in_contact = depends_on_modulus(search, minimum);
    let scatter = Scatter::new(&minimum.residuals, free, &measured.segments, &in_contact);
    let variance = scatter.variance;
    let by_middle = credible(covariance(&minimum.jacobian, variance));
    let baseline_error = BaselineError::new(search, &by_middle);
    let covariance = at_zero(search, by_middle);
    let span = measured.force_span;
    let interacting = if search.tip.model.adheres() {
        let chosen = search.choose(&minimum.variables);
        chosen.map_or_else(Vec::new, |(choice, _)| choice)
    } else {
        // It interacts from first touch on. The place of a transition would be that of chance.
        let touches = |approach: &f64| *approach >= parameters.approach_offset;
        measured.approaches.iter().map(touches).collect()
    };
    let fitted = measured
        .samples
        .iter()
        .zip(minimum.residuals.iter())
        .map(|(sample, residual)| sample.force + residual * span)
        .collect();
    let floor = sum.max(FLOOR * points as f64);
    let transitions = transitions(measured, search.tip.model, &interacting);
    ModelFit {
        model: search.tip.model,
        parameters,
        uncertainties: uncertainties(search, &parameters, &covariance),
        correlations: correlations(&search.variables, &covariance),
        // Where only rounding is left the search finds nothing that is less.
        converged: minimum.converged || sum <= FLOOR * points as f64,
        sum_of_squares: sum * span * span,
        degrees_of_freedom: degrees,
        free,
        aic: aic(floor, points, free + transitions),
        noise: (sum / degrees as f64).sqrt() * span,
        autocorrelation: scatter.autocorrelation,
        in_contact: scatter.in_contact,
        fitted,
        interacting,
        profile: Vec::new(),
        baseline_error,
        variance: variance * span * span,
    }
}
