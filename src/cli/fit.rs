//! `tabor fit`: work of adhesion and modulus from a force curve.

use std::path::{Path, PathBuf};

use clap::Args;

use super::patience::Patience;
use super::quantity::{positive, quantity};
use super::{Failure, folder_or_default, print, say, warn};
use crate::fit::{FitResult, ForceCurve, Freedom, ModelFit, figure, fit_curve, report};
use crate::output::write_atomically;
use crate::theory::jkr;
use crate::units::{Dimension, format_si};

/// What `tabor fit` takes.
#[derive(Debug, Args)]
pub(super) struct FitArguments {
    /// The curve: CSV with the columns approach and force, in SI or with the unit in the head
    #[arg(value_name = "CURVE.csv", required_unless_present = "pull_off")]
    curve: Option<PathBuf>,
    /// Radius of the sphere, as in "10 um"
    #[arg(long, value_name = "R", value_parser = |text: &str| positive(text, Dimension::Length))]
    radius: f64,
    /// Folder for fit.json and fit.png [default: the curve's name, in the current folder]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Approach 0 is where the undeformed surfaces first touch; else that place is fitted
    #[arg(long)]
    contact_at_zero: bool,
    /// Fit the force where nothing acts; else it is 0
    #[arg(long)]
    baseline: bool,
    /// Range of the attraction (work of adhesion over its tension), where it is known
    #[arg(long, value_name = "LENGTH", value_parser = |text: &str| positive(text, Dimension::Length))]
    range: Option<f64>,
    /// In place of a curve, with --stiffness: the pull-off force, for JKR
    #[arg(long, value_name = "FORCE", value_parser = |text: &str| positive(text, Dimension::Force), requires = "stiffness", conflicts_with = "curve")]
    pull_off: Option<f64>,
    /// Slope of force by approach on the way apart
    #[arg(long, value_name = "N/M", value_parser = |text: &str| positive(text, Dimension::ForcePerLength), requires = "pull_off")]
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
            two_numbers(arguments.radius, pull_off, arguments.load, stiffness)
        }
        // clap asks for one of the two.
        _ => Err(Failure::Usage(
            "give a curve, or --pull-off with --stiffness".to_owned(),
        )),
    }
}

fn fit_file(arguments: &FitArguments, path: &Path) -> Result<(), Failure> {
    let curve = ForceCurve::read(path)?;
    let freedom = Freedom {
        approach_offset: !arguments.contact_at_zero,
        force_offset: arguments.baseline,
        range: arguments.range,
    };
    let result = fit_curve(&curve, path, arguments.radius, freedom)?;
    let folder = folder_or_default(arguments.out.as_deref(), path, "");
    let title = path.file_name().unwrap_or_default().to_string_lossy();
    let mut text = format!("{:#}", report(&result, path));
    text.push('\n');
    table(&result).lines().for_each(say);
    for warning in &result.warnings {
        warn(warning);
    }
    write_atomically(&folder.join("fit.json"), text.as_bytes())?;
    figure(&result, &title).write(&folder.join("fit.png"))?;
    say(&format!(
        "{} and fit.png written",
        folder.join("fit.json").display()
    ));
    Ok(())
}

/// JKR's inversion, as a line of CSV on standard output.
fn two_numbers(radius: f64, pull_off: f64, load: f64, stiffness: f64) -> Result<(), Failure> {
    let sphere = jkr::from_measurement(radius, pull_off, load, stiffness)?;
    let text = format!(
        "work_of_adhesion,contact_modulus\n{:?},{:?}\n",
        sphere.work_of_adhesion(),
        sphere.contact_modulus()
    );
    print(&text)
}

/// Every model with its numbers, the one that is taken marked, and what it comes to.
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
    let taken = |value: f64, deviation: Option<f64>, unit: &str| match deviation {
        Some(deviation) => format!(
            "{} +- {}",
            format_si(value, unit),
            format_si(deviation, unit)
        ),
        None => format_si(value, unit),
    };
    text += &format!("{}:", best.model.title());
    if best.model.adheres() {
        let work = best.parameters.work_of_adhesion;
        text += &format!(" w = {},", taken(work, result.work_uncertainty, "J/m^2"));
    }
    let modulus = best.parameters.contact_modulus;
    text += &format!(" E* = {}", taken(modulus, result.modulus_uncertainty, "Pa"));
    if let Some(mu) = result.tabor_parameter {
        text += &format!(", Tabor number {mu:.3}");
    }
    text + "\n"
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
