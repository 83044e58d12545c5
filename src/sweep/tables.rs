//! `sweep.csv`, one row a case and step, and `runs.csv`, one row a case.

use super::outcome::{Outcome, QUANTITIES};
use crate::output::csv_line::csv_line;

/// One row a case and step: the case's number, the values of all keys, and the columns of `curve.csv`.
pub(super) fn steps_table(keys: &[&str], outcomes: &[&Outcome]) -> String {
    let mut names: Vec<&str> = Vec::new();
    for outcome in outcomes.iter().filter(|outcome| !outcome.rows.is_empty()) {
        for name in outcome.header.split(',') {
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    let mut text = csv_line(["case"].iter().chain(keys).chain(&names));
    for outcome in outcomes {
        let own: Vec<&str> = outcome.header.split(',').collect();
        let places: Vec<Option<usize>> = names
            .iter()
            .map(|name| own.iter().position(|known| known == name))
            .collect();
        let first: Vec<String> = std::iter::once(outcome.number.to_string())
            .chain(outcome.values.iter().cloned())
            .collect();
        for row in &outcome.rows {
            // Numbers and words without commas.
            let cells: Vec<&str> = row.split(',').collect();
            let values = places
                .iter()
                .map(|place| place.and_then(|place| cells.get(place).copied()))
                .map(Option::unwrap_or_default);
            text.push_str(&csv_line(first.iter().map(String::as_str).chain(values)));
        }
    }
    text
}

/// One row a case: its number, the values of all keys, how it ended, and the quantities of the whole run.
pub(super) fn runs_table(keys: &[&str], outcomes: &[&Outcome]) -> String {
    let names = QUANTITIES.map(|quantity| quantity.name);
    let mut text = csv_line(
        ["case"]
            .iter()
            .chain(keys)
            .chain(&["status", "steps"])
            .chain(&names)
            .chain(&["seconds", "message"]),
    );
    for outcome in outcomes {
        let mut cells = vec![outcome.number.to_string()];
        cells.extend(outcome.values.iter().cloned());
        cells.push(outcome.status.name().to_owned());
        cells.push(outcome.rows.len().to_string());
        let missing = std::iter::repeat(String::new());
        let quantities = outcome.quantities.iter().cloned().chain(missing);
        cells.extend(quantities.take(QUANTITIES.len()));
        cells.push(format!("{:?}", outcome.seconds));
        cells.push(outcome.message.replace('\n', "; "));
        text.push_str(&csv_line(cells));
    }
    text
}
