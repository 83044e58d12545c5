//! The values of a model's parameters, and the places of its rows.

use std::collections::BTreeMap;

use super::catalogue::Model;
use super::meant;
use super::parameters::{Kind, Need, Parameter};
use super::words::{misses, pairs, quantity};
use crate::cli::Failure;
use crate::theory::Law;
use crate::units::{Dimension, format_si, quoted};

/// Most rows of a table: of the slowest model some seconds.
const MOST_ROWS: f64 = 1e5;

/// What was given and what is assumed, checked one by one.
#[derive(Default)]
pub(super) struct Values {
    numbers: BTreeMap<&'static str, f64>,
    words: BTreeMap<&'static str, &'static str>,
}

impl Values {
    /// Reads `--key value` and `--key=value`; a minus in a key stands for an underscore.
    ///
    /// # Errors
    /// A message for each thing that is wrong.
    pub fn read(model: &Model, words: &[String]) -> Result<Self, Vec<String>> {
        let mut problems = Vec::new();
        let given = pairs(model, words, &mut problems);
        let mut values = Values::default();
        for parameter in model.parameters() {
            let text = match (given.get(parameter.name), parameter.need) {
                (Some(text), _) => text.as_deref(),
                (None, Need::Default(text)) => Some(text),
                (None, _) => None,
            };
            if let Some(Err(problem)) = text.map(|text| values.set(parameter, text)) {
                problems.push(problem);
            }
            problems.extend(misses(model, parameter, |name| given.contains_key(name)));
        }
        if let (Some(from), Some(to)) = (values.given("from"), values.given("to"))
            && from == to
        {
            problems.push("--from and --to are the same; a table needs a way to go".to_owned());
        }
        if problems.is_empty() {
            Ok(values)
        } else {
            Err(problems)
        }
    }

    fn set(&mut self, parameter: &Parameter, text: &str) -> Result<(), String> {
        let name = parameter.name;
        match parameter.kind {
            Kind::Word(words) => {
                let known = words.iter().find(|word| **word == text).ok_or_else(|| {
                    format!(
                        "--{name} {} is not one of {}{}",
                        quoted(text),
                        words.join(", "),
                        meant(text, "", words.iter().copied())
                    )
                })?;
                self.words.insert(name, known);
            }
            Kind::Count => {
                let number = quantity(name, text, Dimension::Dimensionless)?;
                if number.fract() != 0.0 || !(2.0..=MOST_ROWS).contains(&number) {
                    return Err(format!(
                        "--{name} {text} is out of range: it must be a whole number between 2 and {MOST_ROWS}"
                    ));
                }
                self.numbers.insert(name, number);
            }
            Kind::Quantity(dimension, allowed) => {
                let number = quantity(name, text, dimension)?;
                if !allowed.holds(number) {
                    return Err(format!(
                        "--{name} {} is out of range: it must be {}",
                        quoted(text),
                        allowed.words(dimension)
                    ));
                }
                self.numbers.insert(name, number);
            }
        }
        Ok(())
    }

    /// A quantity that was given or has a default, in SI.
    pub fn given(&self, name: &str) -> Option<f64> {
        self.numbers.get(name).copied()
    }

    /// A quantity that is required or has a default, in SI.
    pub fn number(&self, name: &str) -> f64 {
        let number = self.given(name);
        debug_assert!(number.is_some(), "{name} is not a parameter of this model");
        // Theories refuse this one.
        number.unwrap_or(f64::NAN)
    }

    /// A word that has a default.
    pub fn word(&self, name: &str) -> &'static str {
        let word = self.words.get(name).copied();
        debug_assert!(word.is_some(), "{name} is not a word of this model");
        word.unwrap_or("")
    }

    /// The law named.
    pub fn law(&self) -> Law {
        match self.word("law") {
            "cubic" => Law::Cubic,
            "exponential" => Law::Exponential,
            "maugis-dugdale" => Law::Dugdale,
            _ => Law::LennardJones,
        }
    }

    /// Whether the surfaces come together; else they go apart.
    pub fn together(&self) -> bool {
        self.word("direction") == "together"
    }

    /// Places of the rows, evenly from `--from` to `--to`, or the model's own choice of them.
    pub fn places(&self, from: f64, to: f64) -> Result<Vec<f64>, Failure> {
        self.places_within(from, to, (f64::NEG_INFINITY, f64::INFINITY), "")
    }

    /// The same, where both ends must lie within `limits`, one of them perhaps infinite; all in
    /// `unit`.
    pub fn places_within(
        &self,
        from: f64,
        to: f64,
        limits: (f64, f64),
        unit: &str,
    ) -> Result<Vec<f64>, Failure> {
        let ends = [("from", from), ("to", to)]
            .map(|(name, chosen)| (name, self.given(name).unwrap_or(chosen)));
        let [low, high] = [limits.0, limits.1].map(|limit| format_si(limit, unit));
        let allowed = match limits {
            (f64::NEG_INFINITY, _) => format!("no more than {high}"),
            (_, f64::INFINITY) => format!("no less than {low}"),
            _ => format!("between {low} and {high}"),
        };
        let problems: Vec<String> = ends
            .iter()
            .filter(|(_, end)| !(limits.0..=limits.1).contains(end))
            .map(|(name, end)| {
                format!(
                    "--{name} {} is out of range: it must be {allowed} here",
                    format_si(*end, unit)
                )
            })
            .collect();
        if !problems.is_empty() {
            return Err(super::usage(&problems));
        }
        let [(_, from), (_, to)] = ends;
        if from == to {
            return Err(Failure::Usage(format!(
                "--from and --to are the same, {from:?} {unit}; a table needs a way to go"
            )));
        }
        // A row at 0 is there, not beside it by rounding: JKR's surfaces touch from 0 on.
        let rounding = 1e-15 * from.abs().max(to.abs());
        let place = |share: f64| {
            let at = from * (1.0 - share) + to * share;
            if at.abs() <= rounding { 0.0 } else { at }
        };
        Ok(self.spread(place, from, to))
    }

    /// Places of the rows, evenly in the logarithm; both ends are positive.
    pub fn places_by_factor(&self, from: f64, to: f64) -> Result<Vec<f64>, Failure> {
        let from = self.given("from").unwrap_or(from);
        let to = self.given("to").unwrap_or(to);
        if from == to {
            return Err(Failure::Usage(format!(
                "--from and --to are the same, {from:?}; a table needs a way to go"
            )));
        }
        Ok(self.spread(|share| from * (to / from).powf(share), from, to))
    }

    /// Rows at `place` of shares from 0 to 1; the ends are exact.
    fn spread(&self, place: impl Fn(f64) -> f64, from: f64, to: f64) -> Vec<f64> {
        let last = self.number("points") - 1.0;
        let inner = (1..last as usize).map(|index| place(index as f64 / last));
        std::iter::once(from)
            .chain(inner)
            .chain(std::iter::once(to))
            .collect()
    }

    /// What was given or assumed, in the order of the model's parameters: name, value, unit.
    pub fn shown(&self, model: &Model) -> Vec<(&'static str, String)> {
        let show = |parameter: &Parameter| {
            let name = parameter.name;
            match parameter.kind {
                Kind::Word(_) => self.words.get(name).map(|word| (*word).to_owned()),
                Kind::Count => self.given(name).map(|number| format!("{number}")),
                Kind::Quantity(dimension, _) => self.given(name).map(|number| {
                    format!("{number:?} {}", dimension.unit())
                        .trim_end()
                        .to_owned()
                }),
            }
            .map(|text| (name, text))
        };
        model.parameters().filter_map(show).collect()
    }
}
