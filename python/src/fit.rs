//! Force curves fitted.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use tabor::fit::{
    ColumnChoice, CurveColumns, FitError, FitRequest, FitResult, ForceCurve, Indenter, headline,
    report, table,
};

use crate::errors;
use crate::surface::apart;

/// What to fit, and how; lengths in m, angles in rad.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct How {
    /// "sphere", "cone" or "pyramid".
    tip: String,
    /// Radius of the sphere, or half angle.
    tip_size: f64,
    contact_at_zero: bool,
    baseline: bool,
    baseline_slope: bool,
    columns: Vec<String>,
    sensitivity: Option<f64>,
    spring: Option<f64>,
    spring_error: f64,
    radius_error: f64,
    relaxation: bool,
    advise: bool,
    range: Option<f64>,
}

/// The report of a fit as JSON, the curve with the model as CSV, the result in a line, and warnings.
type Fitted = (String, String, String, Vec<String>);

/// Fits a file, or the CSV `text` of a curve that messages call `path`.
#[pyfunction]
pub fn fit(py: Python<'_>, path: PathBuf, text: Option<String>, how: How) -> PyResult<Fitted> {
    let refused = |words: &str| errors::raise(py, "FitError", words);
    let mut columns = CurveColumns::default();
    (columns.sensitivity, columns.spring) = (how.sensitivity, how.spring);
    columns.choices = how
        .columns
        .iter()
        .map(|choice| ColumnChoice::parse(choice))
        .collect::<Result<_, _>>()
        .map_err(|words| refused(&format!("columns: {words}")))?;
    let tip = match how.tip.as_str() {
        "cone" => Indenter::Cone {
            half_angle: how.tip_size,
        },
        "pyramid" => Indenter::Pyramid {
            half_angle: how.tip_size,
        },
        _ => Indenter::from(how.tip_size),
    };
    let named = path.clone();
    let solve = move || -> Result<FitResult, FitError> {
        let curve = match text {
            Some(text) => ForceCurve::parse(text.as_bytes(), &path, &columns)?,
            None => ForceCurve::read_columns(&path, &columns)?,
        };
        let mut request = FitRequest::default();
        request.contact_at_zero = how.contact_at_zero;
        request.baseline = how.baseline;
        request.baseline_slope = how.baseline_slope;
        request.range = how.range;
        (request.radius_error, request.spring_error) = (how.radius_error, how.spring_error);
        (request.relaxation, request.advise) = (how.relaxation, how.advise);
        request.fit(&curve, &path, tip)
    };
    let mut result =
        apart(py, &Arc::default(), solve)?.map_err(|error| refused(&error.to_string()))?;
    let warnings = std::mem::take(&mut result.warnings);
    Ok((
        report(&result, &named).to_string(),
        table(&result),
        headline(&result),
        warnings,
    ))
}
