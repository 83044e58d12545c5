//! What is kept of a case.

use std::str::FromStr;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::cases::{Case, value_at};
use crate::effect::Effect;
use crate::output::curve::{HEADER, format_row, header};
use crate::run::{RunEnd, RunStatus};
use crate::scene::Scene;
use crate::study::Column;
use crate::units::{Dimension, parse_any_quantity};

/// A quantity of a whole run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quantity {
    /// Its column in `runs.csv`.
    pub name: &'static str,
    /// Its SI unit; `%` for a share that a picture shows in per cent.
    pub unit: &'static str,
    value: fn(&RunEnd) -> Option<f64>,
}

const fn quantity(
    name: &'static str,
    unit: &'static str,
    value: fn(&RunEnd) -> Option<f64>,
) -> Quantity {
    Quantity { name, unit, value }
}

/// Quantities of a whole run, in the order of `runs.csv`, SI.
pub(super) const QUANTITIES: [Quantity; 12] = [
    quantity("largest_contact_area_fraction", "%", |end| {
        end.summary.largest_contact_area_fraction
    }),
    quantity("pull_off_force", "N", |end| end.summary.pull_off_force),
    quantity("pull_off_lower", "N", |end| end.summary.pull_off_lower),
    quantity("pull_off_upper", "N", |end| end.summary.pull_off_upper),
    quantity("hysteresis_energy", "J", |end| {
        end.summary.hysteresis_energy
    }),
    quantity("jumps_in", "", |end| {
        Some(end.summary.jump_in_steps.len() as f64)
    }),
    quantity("jumps_off", "", |end| {
        Some(end.summary.jump_off_steps.len() as f64)
    }),
    quantity("last_force", "N", |end| {
        end.rows.last().map(|row| row.force)
    }),
    quantity("last_contact_area_fraction", "%", |end| {
        end.rows.last().map(|row| row.contact_area_fraction)
    }),
    quantity("iterations", "", |end| {
        Some(end.rows.iter().map(|row| row.iterations as f64).sum())
    }),
    quantity("transforms", "", |end| Some(end.summary.transforms)),
    // Behind the others: outcomes of before have none.
    quantity("hysteresis_uncertainty", "J", |end| {
        end.summary.hysteresis_uncertainty
    }),
];

/// Before the name of a column of an effect: its value in the last row.
const LAST: &str = "last_";

/// The names of all quantities of a run, those of all effects behind the others.
pub(super) fn quantity_names() -> impl Iterator<Item = String> {
    let columns = Effect::ALL.into_iter().flat_map(Effect::columns);
    QUANTITIES
        .into_iter()
        .map(|quantity| quantity.name.to_owned())
        .chain(columns.map(last_of))
}

/// The name of the quantity that a column of an effect is in the last row.
pub(super) fn last_of(column: &str) -> String {
    format!("{LAST}{column}")
}

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// Every step is solved.
    Finished,
    /// The last row did not reach the tolerance, or pull-off is not known as closely as asked.
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

/// The result of a case: one line of the file of cases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// The case's number, from 1.
    pub number: usize,
    /// For each key its value, as a cell of a table: a number in SI where the scene takes one, else its text.
    pub values: Vec<String>,
    /// How it ended.
    pub status: Status,
    /// Why it did not end well, or its warnings.
    pub message: String,
    /// Seconds that it took.
    pub seconds: f64,
    /// Quantities of the whole run as cells, since JSON may lose the last bit of a number; empty where it has none.
    pub quantities: Vec<String>,
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
            _ => {
                let status = match end.pull_off_is_loose(&scene.loading) {
                    true => Status::NotConverged,
                    false => Status::Finished,
                };
                (status, end.summary.warnings.join("; "))
            }
        };
        let rows = end.rows.iter().map(|row| format_row(row, &columns));
        Outcome {
            number: case.number,
            values: values(case, Some(scene)),
            status,
            message,
            seconds,
            quantities: QUANTITIES
                .map(|quantity| (quantity.value)(end).map(number_cell).unwrap_or_default())
                .into(),
            header: header(&columns),
            rows: rows.map(|row| row.trim_end().to_owned()).collect(),
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
            quantities: vec![String::new(); QUANTITIES.len()],
            header: String::new(),
            rows: Vec::new(),
        }
    }

    /// Whether every step is solved, so that the case is not solved again.
    pub fn is_finished(&self) -> bool {
        self.status == Status::Finished
    }

    /// A quantity by its name.
    pub(super) fn quantity(&self, name: &str) -> Option<f64> {
        match QUANTITIES.iter().position(|known| known.name == name) {
            Some(place) => self.quantities.get(place)?.parse().ok(),
            None => self.last(name.strip_prefix(LAST)?)?.parse().ok(),
        }
    }

    /// Columns of effects in its rows.
    pub(super) fn effect_columns(&self) -> impl Iterator<Item = &str> {
        let behind = self.header.strip_prefix(HEADER).unwrap_or_default();
        behind.split(',').filter(|column| !column.is_empty())
    }

    /// The cell of a column of an effect in the last row.
    pub(super) fn last(&self, column: &str) -> Option<&str> {
        let place = self.effect_columns().position(|known| known == column)?;
        let before = HEADER.split(',').count();
        self.rows.last()?.split(',').nth(before + place)
    }
}

/// The SI unit of a quantity of these runs, `%` for a share.
pub(super) fn unit_of_quantity(name: &str, outcomes: &[&Outcome]) -> &'static str {
    let known = QUANTITIES.iter().find(|known| known.name == name);
    let is_there = |column: &str| {
        let mut columns = outcomes.iter().flat_map(|outcome| outcome.effect_columns());
        columns.any(|known| known == column)
    };
    match (known, name.strip_prefix(LAST)) {
        (Some(quantity), _) => quantity.unit,
        (None, Some(column)) => Effect::unit_of_column(column, is_there).unwrap_or_default(),
        (None, None) => "",
    }
}

/// A number as a cell, to the last bit; a count without a decimal point.
fn number_cell(value: f64) -> String {
    /// Whole numbers below this one have all their digits in a double.
    const EXACT: f64 = 1e15;
    if value.fract() == 0.0 && value.abs() < EXACT {
        format!("{value:.0}")
    } else {
        format!("{value:?}")
    }
}

/// The value of each key as a cell, as the scene understood it.
fn values(case: &Case, scene: Option<&Scene>) -> Vec<String> {
    let resolved = scene.map(Scene::resolved_json);
    let value = |(key, text): &(String, String)| {
        let understood = resolved.as_ref().and_then(|scene| value_at(scene, key));
        match understood.and_then(Value::as_f64) {
            Some(number) => number_cell(number),
            None => written(text),
        }
    };
    case.settings.iter().map(value).collect()
}

/// A value as it is written, in SI where it is a quantity: the resolved scene has another key in its place.
pub(super) fn written(text: &str) -> String {
    // A text is itself; anything else stays as TOML has it.
    let text = match toml::Value::from_str(text) {
        Ok(toml::Value::String(text)) => text,
        _ => text.to_owned(),
    };
    match parse_any_quantity(&text) {
        Some((radians, Dimension::Angle)) => number_cell(radians.to_degrees()),
        Some((value, _)) => number_cell(value),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    /// The resolved scene has a ramp a step, of -1 um to 0 and of a fifth of a second first.
    #[test]
    fn keys_of_ramps_are_told_as_they_are_written() {
        let scene = "[grid]\npoints = 8\nsize = 1e-5\n[solid]\ncontact_modulus = 1e6\n[[solid.relaxation]]\nmodulus = 1e6\n\
                     time = 1\n[[surface]]\nkind = \"sphere\"\nradius = 1e-4\n[loading]\ncontrol = \"approach\"\nstart = -1e-6\n\
                     [[loading.ramp]]\nto = 1e-6\nsteps = 2\nduration = 0.4\n[[loading.ramp]]\nto = -1e-6\nsteps = 4\nduration = 2\n";
        let scene = Scene::parse(scene, "scene.toml", Path::new("."), &[]).expect("a scene");
        let written = [
            ("0.to", "1e-6"),
            ("0.duration", "\"0.4 s\""),
            ("1.steps", "4"),
            ("1.duration", "2"),
        ];
        let settings = written.map(|(key, text)| (format!("loading.ramp.{key}"), text.to_owned()));
        let case = Case {
            number: 1,
            settings: settings.into(),
        };
        assert_eq!(values(&case, Some(&scene)), ["1e-6", "0.4", "4", "2"]);
    }

    /// TOML has several ways to quote; none of them is part of the text.
    #[test]
    fn a_text_is_written_without_its_quotes() {
        for text in ["plain", "c\"d", "\"quoted\"", "e\nf", "it's", "a,b"] {
            let value = toml::Value::String(text.to_owned()).to_string();
            assert_eq!(written(&value), text, "{value}");
        }
        assert_eq!(written("\"25 um\""), "2.5e-5");
        assert_eq!(written("[1, 2]"), "[1, 2]");
        assert_eq!(written("true"), "true");
    }
}
