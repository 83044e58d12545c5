//! `fit.json` and `fit.csv`. `docs/fit.md` describes their keys and columns.

use std::path::Path;

use serde_json::{Map, Value, json};

use super::advice::Advice;
use super::choice::FitResult;
use super::estimate::ModelFit;
use crate::output::csv_line::{csv_line, csv_number};

/// The results of a fit, SI; a number that the curve does not determine is null.
pub fn report(result: &FitResult, path: &Path) -> Value {
    let best = result.best();
    let measured = &result.measured;
    let indenter = measured.indenter;
    let radius = indenter.radius().unwrap_or(f64::NAN);
    let mut report = Map::new();
    let mut put = |key: &str, value: Value| {
        report.insert(key.to_owned(), value);
    };
    put("version", json!(env!("CARGO_PKG_VERSION")));
    put("curve", json!(path.display().to_string()));
    put("indenter", json!(indenter.name()));
    put("radius", json!(indenter.radius()));
    put(
        "half_angle",
        json!(indenter.half_angle().map(f64::to_degrees)),
    );
    put("points", json!(measured.samples.len()));
    put("model", json!(best.model.name()));
    put("describes_curve", json!(result.describes_curve));
    for (key, value) in numbers(best, radius) {
        put(&key, value);
    }
    // From the comparison of all models; the entries of a single model follow below.
    if best.model.adheres() {
        put(
            "work_of_adhesion",
            measurement(best.parameters.work_of_adhesion, result.work_uncertainty),
        );
    }
    put(
        "contact_modulus",
        measurement(best.parameters.contact_modulus, result.modulus_uncertainty),
    );
    put(
        "baseline_slope",
        result.baseline_slope.map_or(Value::Null, |slope| {
            measurement(slope.value, Some(slope.uncertainty))
        }),
    );
    put(
        "relaxation",
        result.relaxation.map_or(Value::Null, |solid| {
            let quantity = |(value, deviation)| measurement(value, Some(deviation));
            json!({
                "relaxed_modulus": quantity(solid.relaxed_modulus),
                "instantaneous_modulus": quantity(solid.instantaneous_modulus),
                "time": quantity(solid.time),
                "noise": solid.noise,
                "points": solid.points,
            })
        }),
    );
    put("tabor_parameter", json!(result.tabor_parameter));
    put("tabor_uncertainty", json!(result.tabor_uncertainty));
    put(
        "law_error",
        result.law_error.map_or(Value::Null, |error| {
            json!({
                "work_of_adhesion": error.work_of_adhesion,
                "contact_modulus": error.contact_modulus,
            })
        }),
    );
    put(
        "advice",
        result.advice.as_ref().map_or(Value::Null, Advice::report),
    );
    put("correlations", correlations(best));
    put("noise", json!(best.noise));
    put(
        "jkr_inversion",
        result.inversion.map_or(Value::Null, |found| {
            json!({
                "pull_off_force": found.pull_off_force,
                "load": found.load,
                "stiffness": found.stiffness,
                "work_of_adhesion": measurement(found.work_of_adhesion, Some(found.work_uncertainty)),
                "contact_modulus": measurement(found.contact_modulus, Some(found.modulus_uncertainty)),
            })
        }),
    );
    put(
        "models",
        result.fits.iter().map(|fit| model(fit, radius)).collect(),
    );
    put("warnings", json!(result.warnings));
    Value::Object(report)
}

/// First line of `fit.csv`.
const HEADER: [&str; 6] = [
    "approach",
    "position",
    "force",
    "model_force",
    "segment",
    "interacting",
];

/// First line of [`table()`].
pub(crate) fn table_head() -> String {
    csv_line(HEADER)
}

/// The curve with the fitted model, one row a point, SI: approach of the probe and position of the base of the
/// cantilever (empty without a spring constant), both as measured.
pub fn table(result: &FitResult) -> String {
    let fit = result.best();
    let mut text = table_head();
    for segment in &result.measured.segments {
        for at in segment.points.clone() {
            let sample = result.as_measured[at];
            // The slope of the baseline, which the fit leaves out.
            let baseline = sample.force - result.measured.samples[at].force;
            let position = result
                .spring
                .map(|spring| sample.approach + sample.force / spring);
            text += &csv_line([
                csv_number(Some(sample.approach)),
                csv_number(position),
                csv_number(Some(sample.force)),
                csv_number(Some(fit.fitted[at] + baseline)),
                if segment.loading {
                    "loading"
                } else {
                    "unloading"
                }
                .to_owned(),
                fit.interacting[at].to_string(),
            ]);
        }
    }
    text
}

fn model(fit: &ModelFit, radius: f64) -> Value {
    let mut entry = Map::new();
    entry.insert("model".to_owned(), json!(fit.model.name()));
    entry.extend(numbers(fit, radius));
    entry.extend([
        ("converged".to_owned(), json!(fit.converged)),
        ("chi_squared".to_owned(), json!(fit.sum_of_squares)),
        (
            "degrees_of_freedom".to_owned(),
            json!(fit.degrees_of_freedom),
        ),
        ("aic".to_owned(), json!(fit.aic)),
        ("noise".to_owned(), json!(fit.noise)),
        ("autocorrelation".to_owned(), json!(fit.autocorrelation)),
        (
            "contact_autocorrelation".to_owned(),
            json!(fit.contact_autocorrelation()),
        ),
        ("correlations".to_owned(), correlations(fit)),
    ]);
    Value::Object(entry)
}

/// The numbers of a model under their names.
fn numbers(fit: &ModelFit, radius: f64) -> Vec<(String, Value)> {
    let (values, deviations) = (&fit.parameters, &fit.uncertainties);
    let adhesive = fit.model.adheres().then_some(values.work_of_adhesion);
    let lambda = fit.tabor_parameter().map(|_| values.maugis_parameter);
    let named = [
        ("work_of_adhesion", adhesive, deviations.work_of_adhesion),
        (
            "contact_modulus",
            Some(values.contact_modulus),
            deviations.contact_modulus,
        ),
        ("maugis_parameter", lambda, deviations.maugis_parameter),
        ("range", fit.range(radius), deviations.range),
        (
            "peak_tension",
            fit.peak_tension(radius),
            deviations.peak_tension,
        ),
        (
            "approach_offset",
            Some(values.approach_offset),
            deviations.approach_offset,
        ),
        (
            "force_offset",
            Some(values.force_offset),
            deviations.force_offset,
        ),
    ];
    named
        .into_iter()
        .map(|(name, value, deviation)| {
            let shown = value.map_or(Value::Null, |value| measurement(value, deviation));
            (name.to_owned(), shown)
        })
        .collect()
}

fn measurement(value: f64, uncertainty: Option<f64>) -> Value {
    json!({ "value": value, "uncertainty": uncertainty })
}

fn correlations(fit: &ModelFit) -> Value {
    let entries = fit
        .correlations
        .iter()
        .map(|(first, second, value)| (format!("{first},{second}"), json!(value)));
    Value::Object(entries.collect())
}
