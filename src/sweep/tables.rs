//! `sweep.csv`, one row a case and step, and `runs.csv`, one row a case.

use super::outcome::{Outcome, QUANTITIES, last_of};
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

/// One row a case: its number, the values of all keys, how it ended, the quantities of the whole run, and the columns of effects in
/// its last row.
pub(super) fn runs_table(keys: &[&str], outcomes: &[&Outcome]) -> String {
    let names = QUANTITIES.map(|quantity| quantity.name);
    let mut columns: Vec<&str> = Vec::new();
    for column in outcomes.iter().flat_map(|outcome| outcome.effect_columns()) {
        if !columns.contains(&column) {
            columns.push(column);
        }
    }
    let last: Vec<String> = columns.iter().map(|column| last_of(column)).collect();
    let mut text = csv_line(
        ["case"]
            .iter()
            .chain(keys)
            .chain(&["status", "steps"])
            .chain(&names)
            .chain(&["seconds", "message"])
            .copied()
            .chain(last.iter().map(String::as_str)),
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
        let last = columns.iter().map(|column| outcome.last(column));
        cells.extend(last.map(|cell| cell.unwrap_or_default().to_owned()));
        text.push_str(&csv_line(cells));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::curve::HEADER;
    use crate::sweep::outcome::{Status, unit_of_quantity};

    /// The columns of effects stand behind the others, and empty where a case has none.
    #[test]
    fn runs_have_the_columns_of_effects_in_their_last_row() {
        let outcome = |number: usize, columns: &str, row: &str| {
            let common = vec!["1"; HEADER.split(',').count()].join(",");
            let rows = [format!("{common}{row},9"), format!("{common}{row}")];
            Outcome {
                number,
                values: vec!["0.5".to_owned()],
                status: Status::Finished,
                message: "a, b".to_owned(),
                seconds: 1.0,
                quantities: vec![String::new(); QUANTITIES.len()],
                header: format!("{HEADER}{columns}"),
                rows: rows.into(),
            }
        };
        let with = outcome(1, ",conductance,resistance", ",2e-3,500.0");
        let without = outcome(2, "", "");
        let both = [&with, &without];
        let table = runs_table(&["key"], &both);
        let lines: Vec<&str> = table.lines().collect();
        let ends = [
            ",seconds,message,last_conductance,last_resistance",
            ",1.0,\"a, b\",2e-3,500.0",
            ",1.0,\"a, b\",,",
        ];
        for (line, end) in lines.iter().zip(ends) {
            assert!(line.ends_with(end), "{table}");
        }
        assert_eq!(with.quantity("last_conductance"), Some(2e-3));
        assert_eq!(without.quantity("last_conductance"), None);
        // Beside a resistance the conductance is that of a current.
        assert_eq!(unit_of_quantity("last_conductance", &both), "S");
        assert_eq!(unit_of_quantity("last_force", &both), "N");
    }
}
