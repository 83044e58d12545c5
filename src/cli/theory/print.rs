//! Tables, the list of the models and the help of one, as text.

use std::fmt::Write;

use super::catalogue::{Cell, Model, Table};
use super::parameters::{Kind, Need, Parameter};
use super::values::Values;
use crate::output::csv_line::csv_line;
use crate::units::Dimension;

/// The table as CSV: comments on where it comes from, a head of names, the rows.
///
/// Numbers are the shortest that read back bit for bit; what is not defined is empty.
pub(super) fn csv(model: &Model, values: &Values, table: &Table) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let mut comment = |line: &str| {
        let _ = writeln!(text, "# {line}");
    };
    comment(&format!("model: {}, {}", model.name, model.about));
    comment(&format!("source: {}", model.source));
    for (name, value) in values.shown(model) {
        comment(&format!("parameter: {name} = {value}"));
    }
    for note in &table.notes {
        comment(note);
    }
    comment(&format!("columns: {}", model.columns));
    let names = model.columns.split(", ");
    text += &csv_line(names.map(|column| column.split(" [").next().unwrap_or(column)));
    for row in &table.rows {
        text += &csv_line(row.iter().map(shown));
    }
    text
}

fn shown(cell: &Cell) -> String {
    match cell {
        // Adding zero makes a minus zero a plain one.
        Cell::Number(number) if number.is_finite() => format!("{:?}", number + 0.0),
        Cell::Number(_) => String::new(),
        Cell::Word(word) => (*word).to_owned(),
    }
}

/// Every model with its parameters.
pub(super) fn list(models: &[Model]) -> String {
    let mut text = String::from(
        "Analytic models; `tabor theory NAME --KEY VALUE ...` writes a table of one as CSV,\n`tabor theory NAME --help` gives an example. Values are in SI, or text with a unit: \"25 um\".\n",
    );
    for model in models {
        text.push('\n');
        text.push_str(&entry(model));
    }
    text
}

/// One model, with a call to begin from.
pub(super) fn help(model: &Model) -> String {
    format!(
        "{}\nSource: {}.\n\nExample:\n  tabor theory {} {}\n",
        entry(model),
        model.source,
        model.name,
        model.example
    )
}

fn entry(model: &Model) -> String {
    let mut text = format!("{}: {}\n", model.name, model.about);
    for parameter in model.parameters() {
        let _ = writeln!(
            text,
            "  {:<22} {:<7} {}{}",
            format!("--{}", parameter.name),
            unit(parameter),
            parameter.meaning,
            need(parameter)
        );
    }
    let _ = writeln!(text, "  gives {}", model.columns);
    text
}

fn unit(parameter: &Parameter) -> &'static str {
    match parameter.kind {
        // A bare number is in degrees, unlike everything else.
        Kind::Quantity(Dimension::Angle, _) => "deg",
        Kind::Quantity(dimension, _) => dimension.unit(),
        Kind::Count | Kind::Word(_) => "",
    }
}

/// What happens without it, and which words it takes.
fn need(parameter: &Parameter) -> String {
    let words = match parameter.kind {
        Kind::Word(words) => format!(": {}", words.join(", ")),
        Kind::Count | Kind::Quantity(..) => String::new(),
    };
    let rest = match parameter.need {
        Need::Required => String::new(),
        Need::Default(text) | Need::Chosen(text) => format!(" [default: {text}]"),
        Need::Either(other) => format!(" [or --{other}]"),
        Need::With(other) => format!(" [optional, with --{other}]"),
    };
    words + &rest
}
