//! `tabor theory`: analytic models as tables.
//!
//! A model is one entry of the [`catalogue`]: its parameters, its columns and the function that
//! fills them. What a parameter may be is checked here before the model sees it.

mod catalogue;
mod dmt;
mod lennard_jones;
mod map;
mod parameters;
mod print;
mod rough;
mod soft;
mod spheres;
mod summits;
mod values;
mod waves;
mod words;

use clap::CommandFactory;

use super::patience::Patience;
use super::{Arguments, Failure, TheoryArguments, print};
use crate::output::visible_line;
use catalogue::{MODELS, Model};
use values::Values;

/// Prints the table of a model, the help of a model, or the list of the models.
pub(super) fn theory(arguments: &TheoryArguments) -> Result<(), Failure> {
    let patience = Patience::new("fewer rows take less, see --points");
    let text = text(&arguments.words)?;
    drop(patience);
    print(&text)
}

/// What is printed for the words of a call.
pub(super) fn text(words: &[String]) -> Result<String, Failure> {
    let asks = |word: &String| word == "--help" || word == "-h";
    let Some((name, rest)) = words.split_first() else {
        return Ok(print::list(MODELS));
    };
    if asks(name) {
        return Ok(general_help());
    }
    let model = find(name)?;
    if rest.iter().any(asks) {
        return Ok(print::help(model));
    }
    let values = Values::read(model, rest).map_err(|messages| usage(&messages))?;
    let table = (model.table)(&values)?;
    Ok(print::csv(model, &values, &table))
}

fn find(name: &str) -> Result<&'static Model, Failure> {
    if let Some(model) = MODELS.iter().find(|model| model.name == name) {
        return Ok(model);
    }
    let shown = crate::units::quoted(name);
    if name.starts_with('-') {
        return Err(Failure::Usage(format!(
            "{shown} stands where a model's name is due, as in tabor theory jkr --radius \"1 um\"; tabor theory lists the models"
        )));
    }
    let nearest = nearest(name, MODELS.iter().map(|model| model.name));
    Err(Failure::Usage(format!(
        "there is no model {shown}; did you mean {nearest}? tabor theory lists the models"
    )))
}

/// The help of `tabor theory` itself, as clap would print it.
fn general_help() -> String {
    let mut command = Arguments::command();
    command.build();
    command
        .find_subcommand_mut("theory")
        .map_or_else(String::new, |theory| theory.render_help().to_string())
}

fn usage(messages: &[String]) -> Failure {
    let lines: Vec<String> = messages.iter().map(|text| visible_line(text)).collect();
    Failure::Usage(lines.join("\n"))
}

/// The candidate spelled most alike.
fn nearest(word: &str, candidates: impl Iterator<Item = &'static str>) -> &'static str {
    const LONGEST: usize = 64;
    let word: String = word.to_lowercase().chars().take(LONGEST).collect();
    let likeness = |candidate: &str| {
        let edits = strsim::normalized_damerau_levenshtein(&word, candidate);
        // Edits find slips of the finger, the common beginning finds words cut short.
        let share = 0.5 * (edits + strsim::jaro_winkler(&word, candidate));
        // `modulus` means `contact_modulus`.
        let holds = word.len() > 3 && candidate.contains(&word);
        if holds { 0.5 * (1.0 + share) } else { share }
    };
    candidates
        .map(|candidate| (candidate, likeness(candidate)))
        .fold(
            ("", -1.0),
            |best, next| if next.1 > best.1 { next } else { best },
        )
        .0
}

#[cfg(test)]
#[path = "hostile_tests.rs"]
mod tests;
