//! Warnings about a curve and the numbers of its fit.

use super::curve_file::ForceCurve;
use super::estimate::ModelFit;
use super::measured::Measured;
use super::model::Model;
use crate::theory::tabor_map::FORCE_DMT_LIMIT;
use crate::units::format_si;

/// Fewest points without force that determine a fitted baseline.
pub(super) const ZERO_POINTS: usize = 5;
/// Correlation of neighbouring residuals above which, of either sign, a model misses the curve, in addition to the
/// 3/sqrt(points) that chance allows.
const MISFIT_CORRELATION: f64 = 0.3;
/// Correlation of work of adhesion and modulus above which they cannot be separated.
const INSEPARABLE_CORRELATION: f64 = 0.95;
/// Share of the range of the forces below which a deviation is no misfit: models are computed to some 1e-7 of it, and no instrument has so
/// little noise.
const EXACT: f64 = 1e-6;
/// A modulus, Pa, that no solid comes near to: diamond has 1e12.
const TOO_STIFF: f64 = 1e13;
/// What mixes rows, and the way out.
const MIXED: &str = "rows of extension and retraction seem to be mixed, as where a table is sorted by approach; give the rows in the order of the measurement, or one direction alone";
/// Depths in radii from which the approach is rather in another unit, which is off by a thousand at least.
const OTHER_UNIT: f64 = 100.0;
/// Relative standard deviation from which a warning is given.
pub(super) const UNCERTAIN: f64 = 0.3;

/// What tells that a model misses the curve.
struct Misfit {
    /// Correlation of neighbouring residuals.
    correlation: f64,
    /// Root of their mean square, N.
    deviation: f64,
    /// Where: empty for the whole curve.
    place: &'static str,
}

/// Whether the residuals of a fit are correlated, those of all points or of the points in contact: free points have the noise
/// of any model, and enough of them hide the others.
fn misfit(measured: &Measured, fit: &ModelFit) -> Option<Misfit> {
    let is_large = |correlation: f64, points: usize| {
        correlation.abs() > MISFIT_CORRELATION + 3.0 / (points as f64).sqrt()
    };
    if fit.noise <= EXACT * measured.force_span {
        return None;
    }
    if is_large(fit.autocorrelation, measured.samples.len()) {
        return Some(Misfit {
            correlation: fit.autocorrelation,
            deviation: fit.noise,
            place: "",
        });
    }
    let alone = fit.in_contact?;
    is_large(alone.autocorrelation, alone.points).then(|| Misfit {
        correlation: alone.autocorrelation,
        deviation: alone.mean_square.sqrt() * measured.force_span,
        place: " in contact",
    })
}

/// Whether a model misses the curve. Its residuals alternate where rows of extension and retraction are mixed.
pub(super) fn misses(measured: &Measured, fit: &ModelFit) -> bool {
    misfit(measured, fit).is_some()
}

/// Share of the points beyond first touch that are free, below which a curve does not show where an attraction ends, and the share of the
/// measured way that its range exceeds then.
const LEAST_FREE_SHARE: f64 = 0.1;
const LONG_RANGE: f64 = 0.5;

/// A warning where Maugis-Dugdale attracts nearly as far as the curve goes: the force of that attraction falls in a straight line, as does a
/// tilted baseline. Where the sphere is stretched as far as it attracts (larger Tabor numbers) it is the contact that pulls.
fn attraction_as_far_as_measured(measured: &Measured, fit: &ModelFit) -> Option<String> {
    if measured.freedom.baseline_slope || measured.freedom.range.is_some() {
        return None;
    }
    let range = fit.range(measured.indenter.radius()?)?;
    let touch = fit.parameters.approach_offset;
    let apart = (0..measured.samples.len()).filter(|at| measured.approaches[*at] < touch);
    let (pulled, free): (Vec<usize>, Vec<usize>) = apart.partition(|at| fit.interacting[*at]);
    let ways = pulled.iter().chain(&free);
    let way = ways.fold(0.0, |most: f64, at| {
        most.max(touch - measured.approaches[*at])
    });
    let is_free = free.len() as f64 > LEAST_FREE_SHARE * (pulled.len() + free.len()) as f64;
    let acts_apart = fit.tabor_parameter()? < FORCE_DMT_LIMIT;
    (acts_apart && !is_free && pulled.len() >= ZERO_POINTS && range > LONG_RANGE * way).then(|| {
        format!(
            "the attraction reaches {} beyond first touch, nearly as far as the curve ({}), and {} of {} points there are free: a tilted baseline looks the same, and w and E* are then wrong; fit the slope of the baseline (--baseline-slope)",
            format_si(range, "m"),
            format_si(way, "m"),
            free.len(),
            pulled.len() + free.len(),
        )
    })
}

/// A warning where DMT, whose attraction has no end, is in tension at most points beyond first touch: an offset of the
/// force does the same.
fn endless_tension(measured: &Measured, fit: &ModelFit) -> Option<String> {
    if fit.model != Model::Dmt || measured.freedom.force_offset {
        return None;
    }
    let touch = fit.parameters.approach_offset;
    let apart = (0..measured.samples.len()).filter(|at| measured.approaches[*at] < touch);
    let (pulled, free): (Vec<usize>, Vec<usize>) = apart.partition(|at| fit.interacting[*at]);
    let farthest = pulled.iter().map(|at| touch - measured.approaches[*at]);
    let farthest = farthest.fold(0.0, f64::max);
    let tension = -fit.fitted[*pulled.first()?];
    (pulled.len() >= ZERO_POINTS && pulled.len() > free.len()).then(|| {
        format!(
            "the tension of {} is the same as far as {} beyond first touch, where attraction has ended: if it is an offset of the force, w is that alone; fit the baseline",
            format_si(tension, "N"),
            format_si(farthest, "m"),
        )
    })
}

/// Warnings about rows and options that have no effect.
pub(super) fn left_out(curve: &ForceCurve) -> Vec<String> {
    let mut warnings = Vec::new();
    for (lines, why) in [
        (&curve.incomplete, "miss the approach or the force"),
        (&curve.unconverged, "are marked as not converged"),
    ] {
        if let Some(first) = lines.first() {
            warnings.push(format!(
                "{} rows {why} and are left out, the first in line {first}",
                lines.len()
            ));
        }
    }
    if curve.sensitivity_unused {
        warnings.push(
            "the sensitivity changes nothing: the curve has no deflection in volts".to_owned(),
        );
    }
    warnings
}

/// A warning where the forces jump between two branches that are so far apart, N.
pub(super) fn mixed_rows(gap: f64) -> String {
    format!(
        "the forces of neighbouring rows jump by {} and back, again and again: {MIXED}",
        format_si(gap, "N"),
    )
}

/// Warnings about the numbers of a fit.
pub(super) fn add_warnings(measured: &Measured, fit: &ModelFit, warnings: &mut Vec<String>) {
    if let Some(radius) = measured.indenter.radius() {
        let depth = measured.closest() - fit.parameters.approach_offset;
        let is_other_unit = depth > OTHER_UNIT * radius;
        // A search that has not converged may have left the curve.
        if is_other_unit || (fit.converged && depth > radius) {
            warnings.push(format!(
                "the curve presses the sphere in by {:.1} times its radius, and the models hold for depths far below it{}",
                depth / radius,
                if is_other_unit {
                    "; if the approach is not in m, name its unit in the header, as in approach [nm]"
                } else {
                    ""
                }
            ));
        }
    }
    warnings.extend(endless_tension(measured, fit));
    warnings.extend(attraction_as_far_as_measured(measured, fit));
    if fit.parameters.contact_modulus > TOO_STIFF {
        warnings.push(format!(
            "a contact modulus of {} is more than any solid has; if the force is not in N, name its unit in the header, as in force [nN]",
            format_si(fit.parameters.contact_modulus, "Pa"),
        ));
    }
    if !fit.converged {
        warnings.push(format!(
            "the fit of {} did not converge; its numbers are the best found",
            fit.model.title()
        ));
    }
    if let Some(found) = misfit(measured, fit) {
        let Misfit {
            correlation,
            deviation,
            place,
        } = found;
        let title = fit.model.title();
        warnings.push(if correlation < 0.0 {
            format!(
                "the residuals of {title} alternate{place} (correlation {correlation:.2}): {MIXED}",
            )
        } else {
            format!(
                "the residuals of {title} are correlated{place} ({correlation:.2}): the model deviates from the curve by {}, and the uncertainties are no more than orders of magnitude",
                format_si(deviation, "N"),
            )
        });
    }
    for (first, second, correlation) in &fit.correlations {
        if (*first, *second) == ("contact_modulus", "work_of_adhesion")
            && correlation.abs() > INSEPARABLE_CORRELATION
        {
            warnings.push(format!(
                "w and E* are strongly correlated ({correlation:.3}), so that neither is well known by itself"
            ));
        }
    }
    for (name, value, deviation) in [
        (
            "work of adhesion",
            fit.parameters.work_of_adhesion,
            fit.uncertainties.work_of_adhesion,
        ),
        (
            "contact modulus",
            fit.parameters.contact_modulus,
            fit.uncertainties.contact_modulus,
        ),
    ] {
        if let Some(deviation) = deviation
            && deviation > UNCERTAIN * value
        {
            warnings.push(format!(
                "the {name} is known to {:.0} % only",
                100.0 * deviation / value
            ));
        }
    }
}
