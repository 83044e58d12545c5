//! `tabor theory`: analytic models as tables.
//!
//! A model is one entry of the [`catalogue`]: its parameters, its columns and the function that
//! fills them. What a parameter may be is checked here before the model sees it.

mod advise;
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
use crate::scene::suggestion;
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
    let meant = meant(name, "", MODELS.iter().map(|model| model.name));
    let then = if meant.is_empty() { ";" } else { "" };
    Err(Failure::Usage(format!(
        "there is no model {shown}{meant}{then} tabor theory lists the models"
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

/// As in `; did you mean --to?`, where a candidate is almost spelled like the word.
fn meant(word: &str, head: &str, candidates: impl Iterator<Item = &'static str>) -> String {
    suggestion(word, candidates).map_or_else(String::new, |meant| {
        format!("; did you mean {head}{meant}?")
    })
}

#[cfg(test)]
#[path = "hostile_tests.rs"]
mod tests;
