//! What is kept of a case.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::cases::{Case, value_at};
use crate::output::curve::{format_row, header};
use crate::run::{RunEnd, RunStatus};
use crate::scene::Scene;
use crate::study::Column;

/// Quantities of a whole run, in the order of `runs.csv`, SI.
pub(super) const QUANTITIES: [&str; 11] = [
    "largest_contact_area_fraction",
    "pull_off_force",
    "pull_off_lower",
    "pull_off_upper",
    "hysteresis_energy",
    "jumps_in",
    "jumps_off",
    "last_force",
    "last_contact_area_fraction",
    "iterations",
    "transforms",
];

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// Every step is solved.
    Finished,
    /// The last row did not reach the tolerance.
    NotConverged,
    /// There is no result.
    Failed,
}

impl Status {
    /// Its word in `runs.csv`.
    pub fn name(self) -> &'static str {
        match self {
            Status::Finished => "finished",
            Status::NotConverged => "not-converged",
            Status::Failed => "failed",
        }
    }
}

/// The result of a case: one line of the file of finished cases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// The case's number, from 1.
    pub number: usize,
    /// For each key its value: a number in SI where the scene takes one, else its text.
    pub values: Vec<Value>,
    /// How it ended.
    pub status: Status,
    /// Why, if it did not end well.
    pub message: String,
    /// Seconds that it took.
    pub seconds: f64,
    /// Quantities of the whole run; those that it has none of are `null`.
    pub quantities: Vec<Option<f64>>,
    /// Names of the columns of the rows.
    pub header: String,
    /// Rows, one a step, as in `curve.csv`.
    pub rows: Vec<String>,
}

impl Outcome {
    /// The outcome of a case that ran to an end.
    pub(super) fn ended(case: &Case, scene: &Scene, end: &RunEnd, seconds: f64) -> Outcome {
        let columns = Column::for_scene(scene);
        let (status, message) = match end.status {
            RunStatus::NotConverged {
                step,
                residual,
                iterations,
                tolerance,
                ..
            } => (
                Status::NotConverged,
                format!(
                    "step {step} did not converge: residual {residual:.1e} after {iterations} iterations, asked {tolerance:.1e}"
                ),
            ),
            _ => (Status::Finished, String::new()),
        };
        let summary = &end.summary;
        let last = end.rows.last();
        let count = |steps: &[usize]| Some(steps.len() as f64);
        let iterations: usize = end.rows.iter().map(|row| row.iterations).sum();
        Outcome {
            values: values(case, Some(scene)),
            status,
            message,
            seconds,
            quantities: vec![
                summary.largest_contact_area_fraction,
                summary.pull_off_force,
                summary.pull_off_lower,
                summary.pull_off_upper,
                summary.hysteresis_energy,
                count(&summary.jump_in_steps),
                count(&summary.jump_off_steps),
                last.map(|row| row.force),
                last.map(|row| row.contact_area_fraction),
                Some(iterations as f64),
                Some(summary.transforms),
            ],
            header: header(&columns),
            rows: end
                .rows
                .iter()
                .map(|row| format_row(row, &columns).trim_end().to_owned())
                .collect(),
            number: case.number,
        }
    }

    /// The outcome of a case that has no result.
    pub(super) fn failed(
        case: &Case,
        scene: Option<&Scene>,
        message: String,
        seconds: f64,
    ) -> Outcome {
        Outcome {
            number: case.number,
            values: values(case, scene),
            status: Status::Failed,
            message,
            seconds,
            quantities: vec![None; QUANTITIES.len()],
            header: String::new(),
            rows: Vec::new(),
        }
    }

    /// A quantity by its name.
    pub(super) fn quantity(&self, name: &str) -> Option<f64> {
        let place = QUANTITIES.iter().position(|known| *known == name)?;
        self.quantities.get(place).copied().flatten()
    }
}

/// The value of each key, as the scene understood it.
fn values(case: &Case, scene: Option<&Scene>) -> Vec<Value> {
    let resolved = scene.map(Scene::resolved_json);
    let of = |(key, text): &(String, String)| {
        let number = resolved.as_ref().and_then(|scene| value_at(scene, key));
        match number.filter(|value| value.is_number()) {
            Some(number) => number.clone(),
            None => Value::String(text.trim_matches('"').to_owned()),
        }
    };
    case.settings.iter().map(of).collect()
}
