//! Chooses the model of a curve.

use std::path::Path;

use super::advice::Advice;
use super::akaike::aic_of_baseline;
use super::curve_file::{ForceCurve, Sample, name};
use super::deviations::Uncertainties;
use super::error::FitError;
use super::estimate::{ModelFit, fit_model};
use super::hysteresis;
use super::indenter::Indenter;
use super::inversion::{Inversion, invert_curve};
use super::law_error::{LawError, law_error};
use super::measured::{Freedom, Measured};
use super::mixed_rows::gap_of_branches;
use super::model::{Model, Parameters};
use super::profile::ProfilePoint;
use super::relaxation::Relaxation;
use super::signs::check_signs;
use super::slope::{BaselineSlope, Tilt};
use super::warnings::{UNCERTAIN, ZERO_POINTS, add_warnings, left_out, misses, mixed_rows};
use crate::theory::Law;
use crate::theory::tabor_map::{
    FORCE_DMT_LIMIT, JKR_LIMIT, LAMBDA_PER_MU_MATCHED, Regime, Sphere, regime, tabor_parameter,
};
use crate::units::format_si;

/// Difference of Akaike's criterion from which one model is preferred: it is then `exp(6/2) = 20`
/// times as likely.
pub const DECISIVE_AIC: f64 = 6.0;
/// Difference of Akaike's criterion from which a curve shows a contact. Noise alone gains up to 17, in one of a hundred curves 24, by
/// places of first touch and of jumps that suit it.
pub(super) const CONTACT_AIC: f64 = 20.0;
/// If the greatest tension lies within this share of the approach at its closest end, a curve
/// without compression shows no contact.
const CLOSEST: f64 = 0.05;
/// Noises beside a baseline with a slope, and share of the range of the forces as measured, that a force of compression or tension exceeds.
const PRESSED_NOISES: f64 = 5.0;
const PRESSED_SHARE: f64 = 1e-9;
/// Most iterations of model choice and Tabor number.
const ROUNDS: usize = 4;

/// Standard deviations of the Tabor number within which a limit may hold.
const DEVIATIONS: f64 = 2.0;

/// A fitted number with its standard deviation.
type Number = fn(&Parameters, &Uncertainties) -> (f64, Option<f64>);

/// Results of a fit.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FitResult {
    /// The curve with its segments, without the slope of the baseline.
    pub measured: Measured,
    /// Its points as they were measured.
    pub as_measured: Vec<Sample>,
    /// Every fitted model, from the simplest.
    pub fits: Vec<ModelFit>,
    /// The chosen one. Its uncertainties of w, E* and first touch are those of the result.
    pub chosen: usize,
    /// Whether the chosen model describes the curve: its residuals look like noise.
    pub describes_curve: bool,
    /// Spring constant of the cantilever, N/m, where the curve was read with one.
    pub spring: Option<f64>,
    /// Tabor number that the chosen model implies; `None` without adhesion, or if the range is
    /// unknown.
    pub tabor_parameter: Option<f64>,
    /// Standard deviation of the Tabor number, where lambda is determined.
    pub tabor_uncertainty: Option<f64>,
    /// Standard deviation of the work of adhesion, or the spread over indistinguishable models if
    /// that is larger, J/m^2.
    pub work_uncertainty: Option<f64>,
    /// The same of the contact modulus, Pa.
    pub modulus_uncertainty: Option<f64>,
    /// Possible error of work and modulus if the law has another shape than the model's; `None`
    /// without adhesion.
    pub law_error: Option<LawError>,
    /// Work and modulus from pull-off and one stiffness alone, by JKR.
    pub inversion: Option<Inversion>,
    /// One relaxation time of the solid, if it was fitted.
    pub relaxation: Option<Relaxation>,
    /// Slope of the baseline, if it was fitted.
    pub baseline_slope: Option<BaselineSlope>,
    /// Which model suits, if it was asked for.
    pub advice: Option<Advice>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

impl FitResult {
    /// The chosen model.
    pub fn best(&self) -> &ModelFit {
        &self.fits[self.chosen]
    }

    /// The fit of a model.
    pub fn fit_of(&self, model: Model) -> Option<&ModelFit> {
        self.fits.iter().find(|fit| fit.model == model)
    }
}

/// Fits all models of a sphere of a radius (m), or of another tip, to a curve and chooses one; `path` is for messages.
///
/// # Errors
/// A curve without compression or with wrong signs, and one that no model fits.
pub fn fit_curve(
    curve: &ForceCurve,
    path: &Path,
    indenter: impl Into<Indenter>,
    freedom: Freedom,
) -> Result<FitResult, FitError> {
    let indenter = indenter.into();
    indenter.check()?;
    let freedom = Freedom {
        force_offset: freedom.force_offset || freedom.baseline_slope,
        ..freedom
    };
    // The slope is a number of each model; taking out about that of the data lets all that looks at the data see a level
    // baseline.
    let mut tilt = Tilt::of_curve(curve, indenter, freedom);
    let no_fit = || FitError::NoFit { path: name(path) };
    let mut measured = tilt.measured();
    let mut fits: Vec<ModelFit> = indenter
        .models()
        .iter()
        .filter_map(|model| fit_model(&measured, *model))
        .collect();
    check_signs(&measured, &fits, path)?;
    let least_aic = fits.iter().map(|fit| fit.aic).fold(f64::INFINITY, f64::min);
    let shows_contact = aic_of_baseline(&measured) - least_aic > CONTACT_AIC;
    let mut warnings = left_out(curve);
    warnings.extend(indenter.doubt());
    let (chosen, tabor_parameter) = choose(&measured, &fits, &mut warnings).ok_or_else(no_fit)?;
    let work: Number = |p, u| (p.work_of_adhesion, u.work_of_adhesion);
    let modulus: Number = |p, u| (p.contact_modulus, u.contact_modulus);
    let touch: Number = |p, u| (p.approach_offset, u.approach_offset);
    // If the baseline is fitted but not measured, tension may be an offset.
    let zero_known = knows_zero(&measured, &fits[chosen]);
    let baseline_slope = if freedom.baseline_slope {
        if !zero_known && !shows_contact {
            return Err(FitError::NoContact { path: name(path) });
        }
        if !zero_known {
            return Err(FitError::NoBaseline {
                path: name(path),
                points: free_points(&fits[chosen]),
            });
        }
        Some(tilt.level(&mut measured, &mut fits, chosen))
    } else {
        None
    };
    if !zero_known {
        warnings.push(
            format!("fewer than {ZERO_POINTS} points lie where no force acts, so that a fitted baseline cannot be distinguished from adhesion and no uncertainty is given: do not fit the baseline if the zero of the force is known, or measure until the sphere is free"),
        );
    }
    let range_known = freedom.range.is_some();
    let stated =
        |number: Number| deviation(&fits, chosen, range_known, number).filter(|_| zero_known);
    let (work_uncertainty, modulus_uncertainty) = (stated(work), stated(modulus));
    let touch_uncertainty = stated(touch);
    warnings.extend(tilt.doubt(modulus_uncertainty));
    fits[chosen].uncertainties.approach_offset = touch_uncertainty;
    fits[chosen].uncertainties.contact_modulus = modulus_uncertainty;
    if fits[chosen].model.adheres() {
        fits[chosen].uncertainties.work_of_adhesion = work_uncertainty;
    }
    add_warnings(&measured, &fits[chosen], &mut warnings);
    let is_missed = misses(&measured, &fits[chosen]);
    let mixed = gap_of_branches(&measured).filter(|_| !is_missed);
    warnings.extend(mixed.map(mixed_rows));
    warnings.extend(hysteresis::warning(
        &measured,
        fits[chosen].parameters.force_offset,
    ));
    let stiff = fits[chosen].parameters.contact_modulus;
    let (least, greatest) = measured.extremes();
    let baseline = measured.baseline();
    let exceeds = |force: f64| exceeds_noise(force, curve, &measured, &fits);
    let pressed = exceeds(greatest.force - baseline);
    // If the tension grows up to the closest point there may be attraction without contact.
    let grows = measured.closest() - least.approach < CLOSEST * measured.approach_span;
    let uncertain = modulus_uncertainty.is_none_or(|deviation| deviation > UNCERTAIN * stiff);
    // A slope may take any part of a force, so that a modulus is known which is not there.
    if (uncertain || freedom.baseline_slope) && !shows_contact {
        return Err(FitError::NoContact { path: name(path) });
    }
    if !pressed && (grows || uncertain) {
        let path = name(path);
        return Err(if shows_contact && exceeds(baseline - least.force) {
            FitError::NoCompression { path }
        } else {
            FitError::NoContact { path }
        });
    }
    let general = fits.iter().find(|fit| fit.model == Model::MaugisDugdale);
    let tabor_uncertainty = general.and_then(tabor_deviation);
    let law_error = law_error(&measured, &fits[chosen]);
    if let Some(error) = law_error {
        // Nothing to add for a number that the curve does not determine.
        let within = |stated: Option<f64>, error: f64| stated.is_none_or(|stated| stated >= error);
        if !within(work_uncertainty, error.work_of_adhesion)
            || !within(modulus_uncertainty, error.contact_modulus)
        {
            warnings.push(format!(
                "the uncertainties include noise only: if the law of the surfaces has another shape (Lennard-Jones, exponential), w may be wrong by {} and E* by {}",
                format_si(error.work_of_adhesion, "J/m^2"),
                format_si(error.contact_modulus, "Pa"),
            ));
        }
    }
    Ok(FitResult {
        work_uncertainty,
        modulus_uncertainty,
        law_error,
        inversion: invert_curve(&measured, &fits[chosen]),
        describes_curve: !is_missed && mixed.is_none(),
        spring: curve.spring,
        measured,
        as_measured: curve.samples.clone(),
        fits,
        chosen,
        tabor_uncertainty: tabor_parameter.and(tabor_uncertainty),
        tabor_parameter,
        relaxation: None,
        baseline_slope,
        advice: None,
        warnings,
    })
}

/// Standard deviation of a number of the chosen model: its own, or the spread over all states of
/// all models that the curve does not rule out, if that is larger. `None` if the curve does not
/// determine it.
///
/// This is the profile of the sum of squares over all models: if the truth is one of their states,
/// three deviations contain it as often as its sum of squares lies within nine variances of the
/// least. A known range leaves the chosen model and Maugis-Dugdale.
fn deviation(fits: &[ModelFit], chosen: usize, range_known: bool, number: Number) -> Option<f64> {
    let best = &fits[chosen];
    let (value, own) = number(&best.parameters, &best.uncertainties);
    let possible = |fit: &&ModelFit| {
        !range_known || fit.model == best.model || fit.model == Model::MaugisDugdale
    };
    let least = fits
        .iter()
        .filter(possible)
        .min_by(|a, b| a.sum_of_squares.total_cmp(&b.sum_of_squares))?;
    let states = fits.iter().filter(possible).flat_map(ModelFit::states);
    let spread = states.filter_map(|state: ProfilePoint| {
        let rise = (state.sum_of_squares - least.sum_of_squares) / least.variance;
        state.deviation(value, number, rise)
    });
    own.map(|own| spread.fold(own, f64::max))
}

/// Whether a fit with a free baseline has points without force; true if the baseline is known.
fn knows_zero(measured: &Measured, fit: &ModelFit) -> bool {
    !measured.freedom.force_offset || free_points(fit) >= ZERO_POINTS
}

/// The number of points where no force acts.
fn free_points(fit: &ModelFit) -> usize {
    let free = fit.interacting.iter().filter(|interacting| !**interacting);
    free.count()
}

/// Whether a force on one side of the baseline is more than noise. A straight line that is taken out as the slope of the baseline
/// leaves noise and rounding alone.
fn exceeds_noise(force: f64, curve: &ForceCurve, measured: &Measured, fits: &[ModelFit]) -> bool {
    if !measured.freedom.baseline_slope {
        return force > 0.0;
    }
    let noise = fits
        .iter()
        .map(|fit| fit.noise)
        .fold(f64::INFINITY, f64::min);
    let forces = || curve.samples.iter().map(|sample| sample.force);
    let span = forces().fold(f64::NEG_INFINITY, f64::max) - forces().fold(f64::INFINITY, f64::min);
    force > (PRESSED_NOISES * noise).max(PRESSED_SHARE * span)
}

/// The chosen model and the Tabor number it implies.
fn choose(
    measured: &Measured,
    fits: &[ModelFit],
    warnings: &mut Vec<String>,
) -> Option<(usize, Option<f64>)> {
    let place = |model: Model| fits.iter().position(|fit| fit.model == model);
    let best = fits.iter().map(|fit| fit.aic).fold(f64::INFINITY, f64::min);
    if let Some(hertz) = place(Model::Hertz)
        && fits[hertz].aic - best < DECISIVE_AIC
        && !hides_adhesion(measured, &fits[hertz])
    {
        return Some((hertz, None));
    }
    let Some(general) = place(Model::MaugisDugdale) else {
        let least = |a: &usize, b: &usize| fits[*a].aic.total_cmp(&fits[*b].aic);
        return (0..fits.len()).min_by(least).map(|taken| (taken, None));
    };
    let radius = measured.indenter.radius().unwrap_or(f64::NAN);
    let range = fits[general].range(radius);
    let number = |taken: usize| tabor_of(radius, &fits[taken], range);
    let mut taken = general;
    let mut closed = false;
    for _ in 0..ROUNDS {
        let next = number(taken).and_then(|mu| regime(mu).ok());
        let next = next.and_then(|regime| {
            place(match regime {
                Regime::ForceDmt => Model::Dmt,
                Regime::Intermediate => Model::MaugisDugdale,
                Regime::Jkr => Model::Jkr,
            })
        });
        let next = next.unwrap_or(general);
        closed = next == taken;
        taken = next;
        if closed {
            break;
        }
    }
    if !closed {
        taken = general;
    }
    // The limits are chosen if the data do not resolve the difference.
    let beyond = taken != general && fits[taken].aic - fits[general].aic > DECISIVE_AIC;
    // A Tabor number that is compatible with a limit does not justify a richer model.
    let simpler = simpler(fits, general).filter(|_| measured.freedom.range.is_none());
    if let Some(limit) = simpler.filter(|_| beyond || taken == general) {
        taken = limit;
    } else if beyond {
        warnings.push(format!(
            "the Tabor number {:.2} is in the range of {}, but that model does not describe the curve (AIC {:+.1}); Maugis-Dugdale, which holds at any Tabor number, is used",
            number(taken).unwrap_or(f64::NAN),
            fits[taken].model.title(),
            fits[taken].aic - fits[general].aic,
        ));
        taken = general;
    }
    // Maugis-Dugdale holds at any number.
    let spread = tabor_deviation(&fits[general]).unwrap_or(0.0);
    let outside = number(taken).filter(|mu| !holds(fits[taken].model, *mu, DEVIATIONS * spread));
    if let Some(mu) = outside {
        warnings.push(format!(
            "{} suffices by Akaike's criterion, but the curve gives a Tabor number of {mu:.2}, and {} holds {}: the result is that of Maugis-Dugdale, the next model that holds",
            fits[taken].model.title(),
            fits[taken].model.title(),
            range_words(fits[taken].model),
        ));
        taken = general;
    }
    for other in fits.iter().filter(|fit| fit.model != fits[taken].model) {
        let difference = other.aic - fits[taken].aic;
        if difference.abs() < DECISIVE_AIC {
            warnings.push(format!(
                "the curve does not distinguish {} from {} (AIC differ by {:.1}, {DECISIVE_AIC} is needed): {} gives w = {}, E* = {}",
                fits[taken].model.title(),
                other.model.title(),
                difference.abs(),
                other.model.title(),
                format_si(other.parameters.work_of_adhesion, "J/m^2"),
                format_si(other.parameters.contact_modulus, "Pa"),
            ));
        } else if difference < 0.0 {
            warnings.push(format!(
                "{} describes the curve better than {} (AIC {difference:+.1}), though the Tabor number speaks against it",
                other.model.title(),
                fits[taken].model.title(),
            ));
        }
    }
    if fits[general].at_bound() && measured.freedom.range.is_none() {
        let side = if fits[general].parameters.maugis_parameter > 1.0 {
            "only that it is short"
        } else {
            "only that it is long"
        };
        warnings.push(format!(
            "the curve does not determine the range of the attraction, {side}; the Tabor number is a bound"
        ));
    }
    Some((taken, number(taken)))
}

/// Whether a model holds at a Tabor number, or so far from it.
pub(super) fn holds(model: Model, mu: f64, within: f64) -> bool {
    match model {
        Model::Dmt => mu - within <= FORCE_DMT_LIMIT,
        Model::Jkr => mu + within >= JKR_LIMIT,
        Model::Hertz | Model::MaugisDugdale => true,
    }
}

/// The Tabor numbers at which a limit holds, in words.
pub(super) fn range_words(model: Model) -> String {
    match model {
        Model::Dmt => format!("below {FORCE_DMT_LIMIT:.2}"),
        Model::Jkr => format!("above {JKR_LIMIT}"),
        Model::Hertz | Model::MaugisDugdale => "at any".to_owned(),
    }
}

/// Standard deviation of the Tabor number of a general fit.
fn tabor_deviation(fit: &ModelFit) -> Option<f64> {
    Some(fit.uncertainties.maugis_parameter? / LAMBDA_PER_MU_MATCHED)
}

/// Whether a fit without adhesion takes a tension for the baseline, with no point that shows the
/// baseline.
fn hides_adhesion(measured: &Measured, hertz: &ModelFit) -> bool {
    !knows_zero(measured, hertz) && hertz.parameters.force_offset < -3.0 * hertz.noise
}

/// The limit that is indistinguishable from the general model and lies within two standard
/// deviations of its lambda.
fn simpler(fits: &[ModelFit], general: usize) -> Option<usize> {
    let fit = &fits[general];
    let number = fit.tabor_parameter()?;
    let spread = tabor_deviation(fit).unwrap_or(0.0);
    let is_limit = |model: Model| matches!(model, Model::Dmt | Model::Jkr);
    let reaches = |model| is_limit(model) && holds(model, number, DEVIATIONS * spread);
    (0..fits.len())
        .filter(|i| reaches(fits[*i].model) && fits[*i].aic - fit.aic < DECISIVE_AIC)
        .min_by(|a, b| fits[*a].aic.total_cmp(&fits[*b].aic))
}

/// Tabor number of a fit with a Dugdale `range` (m), matched to a Lennard-Jones law of the same
/// work and peak tension.
fn tabor_of(radius: f64, fit: &ModelFit, range: Option<f64>) -> Option<f64> {
    let parameters = fit.parameters;
    let sphere = Sphere::new(
        radius,
        parameters.contact_modulus,
        parameters.work_of_adhesion,
    );
    let range = range? * Law::LennardJones.peak_tension();
    tabor_parameter(&sphere.ok()?, range).ok()
}
