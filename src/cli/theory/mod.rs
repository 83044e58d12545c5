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
use catalogue::{Cell, MODELS, Model, Table};
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
    let mut table = (model.table)(&values)?;
    table.notes.extend(wide_contact(model, &values, &table));
    Ok(print::csv(model, &values, &table))
}

/// A warning of a contact with a sphere that is wider than the sphere.
fn wide_contact(model: &Model, values: &Values, table: &Table) -> Option<String> {
    let radius = values.given("radius")?;
    let mut columns = model.columns.split(", ");
    let column = columns.position(|name| name.starts_with("contact_radius"))?;
    let widest = table
        .rows
        .iter()
        .fold(0.0_f64, |widest, row| match row[column] {
            Cell::Number(found) => widest.max(found),
            Cell::Word(_) => widest,
        });
    (widest > radius).then(|| {
        format!(
            "warning: the contact radius grows to {:.2} radii of the sphere; the model takes the sphere for a paraboloid, as it is near its apex",
            widest / radius
        )
    })
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
