//! Words of the command line: which parameter each belongs to, and which is missing.

use std::collections::BTreeMap;

use super::catalogue::Model;
use super::meant;
use super::parameters::{Allowed, Kind, Need, Parameter};
use crate::units::{Dimension, RANGE_WORDS, angle_from_number, in_range, parse_quantity, quoted};

/// The text given for each parameter; none for one whose value is missing, which is a problem
/// already.
pub(super) fn pairs(
    model: &Model,
    words: &[String],
    problems: &mut Vec<String>,
) -> BTreeMap<&'static str, Option<String>> {
    let mut given = BTreeMap::new();
    let mut words = words.iter().peekable();
    while let Some(word) = words.next() {
        let Some(rest) = word.strip_prefix("--") else {
            problems.push(format!(
                "{} stands where a parameter is due, such as --{}; a value with a space in it needs quotes",
                quoted(word),
                model.parameters[0][0].name
            ));
            continue;
        };
        let (key, value) = match rest.split_once('=') {
            Some((key, value)) => (key, Some(value.to_owned())),
            None => (rest, words.next_if(|next| !next.starts_with("--")).cloned()),
        };
        let spelled = key.replace('-', "_");
        let Some(parameter) = model.parameters().find(|known| known.name == spelled) else {
            let known = model.parameters().map(|known| known.name);
            let meant = meant(&spelled, "--", known);
            let it = if meant.is_empty() { "; it" } else { " It" };
            problems.push(format!(
                "{} has no parameter {}{meant}{it} takes {}",
                model.name,
                quoted(&format!("--{key}")),
                names(model)
            ));
            continue;
        };
        let Some(value) = value else {
            problems.push(format!(
                "--{key} needs a value, such as {}",
                example(parameter)
            ));
            given.insert(parameter.name, None);
            continue;
        };
        if given.insert(parameter.name, Some(value)).is_some() {
            problems.push(format!("--{key} is given twice"));
        }
    }
    given
}

fn names(model: &Model) -> String {
    let names: Vec<String> = model
        .parameters()
        .map(|parameter| format!("--{}", parameter.name))
        .collect();
    names.join(", ")
}

/// What is wrong with a parameter's being given or not.
pub(super) fn misses(
    model: &Model,
    parameter: &Parameter,
    given: impl Fn(&str) -> bool,
) -> Option<String> {
    let (name, here) = (parameter.name, given(parameter.name));
    match parameter.need {
        Need::Required if !here => Some(format!(
            "{} needs --{name}, {}, such as --{name} {}",
            model.name,
            parameter.meaning,
            example(parameter)
        )),
        // The pair is one mistake: its first parameter speaks.
        Need::Either(other) if given(other) == here && comes_first(model, name, other) => {
            Some(if here {
                format!("--{name} and --{other} are both given; give one of the two")
            } else {
                format!(
                    "{} needs --{name} or --{other}, such as --{name} {}",
                    model.name,
                    example(parameter)
                )
            })
        }
        Need::With(other) if given(other) && !here => Some(format!(
            "--{other} needs --{name} beside it, {}, such as --{name} {}",
            parameter.meaning,
            example(parameter)
        )),
        _ => None,
    }
}

fn comes_first(model: &Model, name: &str, other: &str) -> bool {
    let place = |wanted: &str| model.parameters().position(|known| known.name == wanted);
    place(name) < place(other)
}

fn example(parameter: &Parameter) -> String {
    match parameter.kind {
        Kind::Word(words) => words[0].to_owned(),
        Kind::Count => "101".to_owned(),
        Kind::Quantity(Dimension::Dimensionless, Allowed::Positive) => "0.5".to_owned(),
        Kind::Quantity(dimension, _) => dimension.example().to_owned(),
    }
}

/// A bare number is in SI (an angle in degrees), text carries its unit.
pub(super) fn quantity(name: &str, text: &str, dimension: Dimension) -> Result<f64, String> {
    if text.is_empty() {
        return Err(format!("--{name} is empty; give {}", dimension.words()));
    }
    let value = match (text.trim().parse::<f64>(), dimension) {
        (Ok(number), _) if !number.is_finite() => {
            return Err(format!("--{name} {} is not finite", quoted(text)));
        }
        (Ok(degrees), Dimension::Angle) => angle_from_number(degrees),
        (Ok(number), _) => number,
        (Err(_), _) => {
            parse_quantity(text, dimension).map_err(|error| format!("--{name}: {error}"))?
        }
    };
    if in_range(value) {
        Ok(value)
    } else {
        Err(format!(
            "--{name} {} is out of range: it must be {RANGE_WORDS}",
            quoted(text)
        ))
    }
}
