//! `tabor fit`: work of adhesion and modulus from a force curve.

use std::f64::consts::FRAC_PI_2;
use std::path::{Path, PathBuf};

use clap::Args;

use super::fit_folder::fit_folder;
use super::patience::Patience;
use super::quantity::{positive, quantity};
use super::{Failure, folder_or_default, print, say, warn};
use crate::fit::advice::Advice;
use crate::fit::{
    ColumnChoice, CurveColumns, FitError, FitRequest, FitResult, ForceCurve, Indenter, ModelFit,
    figure, headline, report, table as curve_table,
};
use crate::output::{expect_apart, expect_table, write_atomically};
use crate::theory::jkr;
use crate::units::{Dimension, angle_from_number, parse_quantity, parse_share};

/// What `tabor fit` takes.
#[derive(Debug, Args)]
pub(super) struct FitArguments {
    /// The curve: CSV with the columns approach and force, in SI or with the unit in the head; a force curve of JPK or
    /// Nanoscope; or a folder of curves
    #[arg(value_name = "CURVE.csv", required_unless_present = "pull_off")]
    curve: Option<PathBuf>,
    /// Radius of the sphere, as in "10 um"
    #[arg(long, value_name = "R", value_parser = |text: &str| positive(text, Dimension::Length), allow_hyphen_values = true, required_unless_present_any = ["cone", "pyramid"])]
    radius: Option<f64>,
    /// In place of a sphere: a cone, by the angle between axis and flank, as in "20 deg"
    #[arg(long, value_name = "ANGLE", value_parser = half_angle, conflicts_with_all = ["radius", "pyramid", "range", "pull_off"])]
    cone: Option<f64>,
    /// A pyramid of four sides, by the angle between axis and face
    #[arg(long, value_name = "ANGLE", value_parser = half_angle, conflicts_with_all = ["radius", "range", "pull_off"])]
    pyramid: Option<f64>,
    /// Folder for fit.json, fit.csv and fit.png [default: the curve's name, in the current folder; for a folder with _fits]
    #[arg(long, value_name = "DIR", conflicts_with = "pull_off")]
    out: Option<PathBuf>,
    /// Approach 0 is where the undeformed surfaces first touch; else that place is fitted
    #[arg(long, conflicts_with = "pull_off")]
    contact_at_zero: bool,
    /// Fit the force where nothing acts; else it is 0
    #[arg(long, conflicts_with = "pull_off")]
    baseline: bool,
    /// Fit the slope of that force too
    #[arg(long, conflicts_with = "pull_off")]
    baseline_slope: bool,
    /// Columns of an instrument, as in "position=Z [um],deflection=Defl [V]": approach or position (of the cantilever's
    /// base), force or deflection, time, each by its name or number; - before it turns its sign
    #[arg(long, value_name = "QUANTITY=COLUMN", value_delimiter = ',', value_parser = ColumnChoice::parse, conflicts_with = "pull_off")]
    columns: Vec<ColumnChoice>,
    /// Deflection per volt, as in "50 nm/V"
    #[arg(long, value_name = "M/V", value_parser = |text: &str| positive(text, Dimension::LengthPerVoltage), allow_hyphen_values = true, conflicts_with = "pull_off")]
    sensitivity: Option<f64>,
    /// Spring constant of the cantilever, as in "0.2 N/m"
    #[arg(long, value_name = "N/M", value_parser = |text: &str| positive(text, Dimension::ForcePerLength), allow_hyphen_values = true, conflicts_with = "pull_off")]
    spring: Option<f64>,
    /// Relative standard deviation of the spring constant, as in 10%
    #[arg(long, value_name = "SHARE", value_parser = parse_share, default_value = "0", hide_default_value = true, conflicts_with = "pull_off")]
    spring_error: f64,
    /// Relative standard deviation of the radius
    #[arg(long, value_name = "SHARE", value_parser = parse_share, default_value = "0", hide_default_value = true, conflicts_with_all = ["cone", "pyramid", "pull_off"])]
    radius_error: f64,
    /// Fit one relaxation time of the solid to the loading beside; the curve needs a column time
    #[arg(long, conflicts_with = "pull_off")]
    relaxation: bool,
    /// Say which model suits, with probabilities learned from full fields (docs/advise.md)
    #[arg(long, conflicts_with_all = ["cone", "pyramid", "range", "pull_off"])]
    advise: bool,
    /// Range of the attraction (work of adhesion over its tension), where it is known
    #[arg(long, value_name = "LENGTH", value_parser = |text: &str| positive(text, Dimension::Length), allow_hyphen_values = true, conflicts_with = "pull_off")]
    range: Option<f64>,
    /// In place of a curve, with --stiffness: the pull-off force, for JKR
    #[arg(long, value_name = "FORCE", value_parser = |text: &str| positive(text, Dimension::Force), allow_hyphen_values = true, requires = "stiffness", requires = "radius", conflicts_with = "curve")]
    pull_off: Option<f64>,
    /// Slope of force by approach on the way apart
    #[arg(long, value_name = "N/M", value_parser = |text: &str| positive(text, Dimension::ForcePerLength), allow_hyphen_values = true, requires = "pull_off", conflicts_with = "curve")]
    stiffness: Option<f64>,
    /// Force at which the stiffness was taken, positive in compression
    #[arg(long, value_name = "FORCE", value_parser = |text: &str| quantity(text, Dimension::Force), default_value = "0", requires = "pull_off", allow_hyphen_values = true)]
    load: f64,
}

/// Fits a curve, or turns two numbers into two others.
pub(super) fn fit(arguments: &FitArguments) -> Result<(), Failure> {
    let _patience = Patience::new("a curve of fewer rows takes less");
    match (&arguments.curve, arguments.pull_off, arguments.stiffness) {
        (Some(curve), ..) => fit_file(arguments, curve),
        (None, Some(pull_off), Some(stiffness)) => {
            // clap asks for the radius of a sphere here.
            let radius = arguments.radius.unwrap_or(f64::NAN);
            two_numbers(radius, pull_off, arguments.load, stiffness)
        }
        // clap asks for one of the two.
        _ => Err(Failure::Usage(
            "give a curve, or --pull-off with --stiffness".to_owned(),
        )),
    }
}

/// An angle of a tip, in rad; a bare number is in degrees.
fn half_angle(text: &str) -> Result<f64, String> {
    let angle = match text.trim().parse() {
        Ok(degrees) => angle_from_number(degrees),
        Err(_) => parse_quantity(text, Dimension::Angle).map_err(|error| error.to_string())?,
    };
    Some(angle)
        .filter(|angle| *angle > 0.0 && *angle < FRAC_PI_2)
        .ok_or_else(|| "must lie between 0 and 90 deg".to_owned())
}

impl FitArguments {
    /// The tip; clap asks for one of the three.
    pub(super) fn indenter(&self) -> Indenter {
        match (self.cone, self.pyramid) {
            (Some(half_angle), _) => Indenter::Cone { half_angle },
            (None, Some(half_angle)) => Indenter::Pyramid { half_angle },
            (None, None) => Indenter::from(self.radius.unwrap_or(f64::NAN)),
        }
    }

    /// Fits one curve.
    pub(super) fn fit_curve(&self, path: &Path) -> Result<FitResult, FitError> {
        let mut columns = CurveColumns::default();
        columns.choices.clone_from(&self.columns);
        (columns.sensitivity, columns.spring) = (self.sensitivity, self.spring);
        let curve = ForceCurve::read_columns(path, &columns)?;
        let request = FitRequest {
            contact_at_zero: self.contact_at_zero,
            baseline: self.baseline,
            baseline_slope: self.baseline_slope,
            range: self.range,
            radius_error: self.radius_error,
            spring_error: self.spring_error,
            relaxation: self.relaxation,
            advise: self.advise,
        };
        request.fit(&curve, path, self.indenter())
    }
}

fn fit_file(arguments: &FitArguments, path: &Path) -> Result<(), Failure> {
    if path.is_dir() {
        let out = folder_or_default(arguments.out.as_deref(), path, "_fits");
        return fit_folder(arguments, path, &out);
    }
    let folder = folder_or_default(arguments.out.as_deref(), path, "");
    let [json, csv, png, svg] =
        ["json", "csv", "png", "svg"].map(|end| folder.join("fit").with_extension(end));
    expect_apart([&json, &csv, &png, &svg], [path])?;
    let result = arguments.fit_curve(path)?;
    let data = curve_table(&result);
    expect_table(&csv, data.lines().next().unwrap_or_default())?;
    let title = path.file_name().unwrap_or_default().to_string_lossy();
    let mut text = format!("{:#}", report(&result, path));
    text.push('\n');
    table(&result).lines().for_each(say);
    for warning in &result.warnings {
        warn(warning);
    }
    write_atomically(&json, text.as_bytes())?;
    write_atomically(&csv, data.as_bytes())?;
    figure(&result, &title).write(&png)?;
    say(&format!("{}, fit.csv and fit.png written", json.display()));
    Ok(())
}

/// JKR's inversion, as a line of CSV on standard output.
fn two_numbers(radius: f64, pull_off: f64, load: f64, stiffness: f64) -> Result<(), Failure> {
    let sphere = jkr::from_measurement(radius, pull_off, load, stiffness)?;
    Indenter::from(radius)
        .doubt()
        .iter()
        .for_each(|doubt| warn(doubt));
    let text = format!(
        "work_of_adhesion,contact_modulus\n{:?},{:?}\n",
        sphere.work_of_adhesion(),
        sphere.contact_modulus()
    );
    print(&text)
}

/// Every model with its numbers, the chosen one marked, and the result.
fn table(result: &FitResult) -> String {
    let mut text = format!(
        "  {:<15} {:>24} {:>24} {:>18} {:>9}\n",
        "model", "w [J/m^2]", "E* [Pa]", "lambda", "AIC"
    );
    let best = result.best();
    for fit in &result.fits {
        let mark = if fit.model == best.model { '>' } else { ' ' };
        text += &format!("{mark} {}\n", line(fit, best.aic));
    }
    text += &format!("{}\n", headline(result));
    if let Some(solid) = &result.relaxation {
        text += &format!("{solid}\n");
    }
    for sentence in result.advice.iter().flat_map(Advice::sentences) {
        text += &format!("advice: {sentence}\n");
    }
    text
}

fn line(fit: &ModelFit, least: f64) -> String {
    let with = |value: f64, deviation: Option<f64>| match deviation {
        Some(deviation) => format!("{value:.4e} +- {deviation:.1e}"),
        None => format!("{value:.4e}"),
    };
    let none = String::from("-");
    let work = if fit.model.adheres() {
        with(
            fit.parameters.work_of_adhesion,
            fit.uncertainties.work_of_adhesion,
        )
    } else {
        none.clone()
    };
    let lambda = match (fit.tabor_parameter(), fit.uncertainties.maugis_parameter) {
        (Some(_), Some(deviation)) => {
            format!("{:.3} +- {deviation:.3}", fit.parameters.maugis_parameter)
        }
        (Some(_), None) => format!("{:.3}", fit.parameters.maugis_parameter),
        (None, _) => none,
    };
    format!(
        "{:<15} {work:>24} {:>24} {lambda:>18} {:>+9.1}",
        fit.model.name(),
        with(
            fit.parameters.contact_modulus,
            fit.uncertainties.contact_modulus
        ),
        fit.aic - least,
    )
}
