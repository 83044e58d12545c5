//! Results of an accuracy study.

use super::errors::Errors;
use super::measure::Measured;
use super::pareto;
use super::reference::Reference;
use super::setting::{Setting, Varied};
use crate::scene::Scene;

/// A setting that was run.
#[derive(Clone, Debug)]
pub struct Row {
    /// The setting.
    pub setting: Setting,
    /// The varied quantity.
    pub varied: Varied,
    /// Its results, without the pressure profile.
    pub measured: Measured,
    /// Its errors.
    pub errors: Errors,
    /// Its difference from the scene's own setting on the same grid.
    pub change: Option<f64>,
    /// For a viscoelastic solid and rows that vary only the steps: the difference from the
    /// reference's steps on the same grid.
    pub in_time: Option<Errors>,
    /// Range of its law, m; `None` without one.
    pub range: Option<f64>,
    /// Taper of its law, m.
    pub taper: Option<f64>,
    /// Pixel over cohesive zone.
    pub chi: Option<f64>,
    /// Pixels across the cohesive zone.
    pub zone_pixels: Option<f64>,
}

/// A setting that was skipped.
#[derive(Clone, Debug)]
pub struct LeftOut {
    /// The setting.
    pub words: String,
    /// The reason.
    pub reason: String,
}

/// Results of a study.
#[derive(Clone, Debug)]
pub struct Report {
    /// The scene.
    pub scene: Scene,
    /// The reference; `None` until it is known.
    pub reference: Option<Reference>,
    /// Rows in the order in which they finished.
    pub rows: Vec<Row>,
    /// Skipped settings.
    pub left_out: Vec<LeftOut>,
    /// Whether the user ended the study.
    pub interrupted: bool,
}

impl Report {
    /// Seconds and the error selected by `of`, for each row.
    pub fn costs(&self, of: impl Fn(&Errors) -> Option<f64>) -> Vec<(f64, Option<f64>)> {
        let point = |row: &Row| (row.measured.seconds, of(&row.errors));
        self.rows.iter().map(point).collect()
    }

    /// Uncertainty of the reference for the error selected by `of`; 0 if it has none.
    pub fn uncertainty(&self, of: impl Fn(&Errors) -> Option<f64>) -> f64 {
        let reference = self.reference.as_ref();
        reference
            .and_then(|found| of(&found.uncertainty))
            .unwrap_or(0.0)
    }

    /// Rows on the Pareto front of the error selected by `of`; rows with an error of 100 % are
    /// never on it.
    pub fn pareto(&self, of: impl Fn(&Errors) -> Option<f64>) -> Vec<usize> {
        pareto::pareto(&self.costs(|errors| of(errors).filter(|error| *error < 1.0)))
    }

    /// Order of convergence of an error with the grid: the least-squares slope of logarithms over
    /// all grids of the scene's own setting.
    pub fn order(&self, of: impl Fn(&Errors) -> Option<f64>) -> Option<f64> {
        let own = self.rows.iter().filter(|row| row.varied == Varied::Nothing);
        let points: Vec<(f64, f64)> = own
            .filter_map(|row| {
                let error = of(&row.errors).filter(|error| *error > 0.0)?;
                let pixels = row.setting.points[0].max(row.setting.points[1]) as f64;
                Some((pixels.ln(), error.ln()))
            })
            .collect();
        if points.len() < 3 {
            return None;
        }
        let count = points.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let across: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
        let along: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
        Some(-across / along)
    }
}

/// Seconds in two digits.
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.01 => format!("{:.1} ms", 1e3 * s),
        s if s < 1.0 => format!("{:.0} ms", 1e3 * s),
        s if s < 10.0 => format!("{s:.1} s"),
        s if s < 120.0 => format!("{s:.0} s"),
        s => format!("{:.0} min", s / 60.0),
    }
}
