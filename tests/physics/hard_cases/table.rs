//! The table in docs/hard_cases.md: written when asked, compared otherwise.

use std::fs;

use super::paths::{PATHS, Path};
use crate::shared::trials::is_long;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/hard_cases.md");
const HEAD: &str = "| case | path | outcome | iterations |\n|---|---|---|---:|\n";

/// Iterations may differ by backend, driver and number of lanes: rounding moves a step now and then. They
/// stay within this factor, or so many, of the table's.
const FACTOR: f64 = 1.5;
const MORE: f64 = 15.0;

/// What came of a case on a path.
#[derive(Debug, PartialEq)]
pub struct Entry {
    pub case: String,
    pub path: String,
    pub outcome: String,
    pub iterations: usize,
}

impl Entry {
    /// Its row.
    pub fn line(&self) -> String {
        format!(
            "| {} | {} | {} | {} |",
            self.case, self.path, self.outcome, self.iterations
        )
    }

    fn from_line(line: &str) -> Entry {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let [case, path, outcome, iterations] = cells[..] else {
            panic!("a row of four cells: {line}");
        };
        Entry {
            case: case.to_owned(),
            path: path.to_owned(),
            outcome: outcome.to_owned(),
            iterations: iterations.parse().expect("a number"),
        }
    }

    fn agrees(&self, other: &Entry) -> bool {
        let (least, most) = (
            self.iterations.min(other.iterations),
            self.iterations.max(other.iterations),
        );
        self.outcome == other.outcome
            && most as f64 <= (FACTOR * least as f64).max(least as f64 + MORE)
    }
}

/// Writes the table, or compares it: every case on every path that is here, and nothing else. A case `waits` on a
/// path where it is another's turn.
pub fn keep(entries: &[Entry], here: &[&Path], waits: impl Fn(&str, &Path) -> bool) {
    let page = fs::read_to_string(PAGE).expect("the page");
    let (before, rest) = page.split_once(HEAD).expect("the page has the table");
    let end = rest.find("\n\n").map_or(rest.len(), |at| at + 1);
    let (rows, after) = rest.split_at(end);
    if std::env::var("TABOR_HARD_CASES").is_ok_and(|word| word == "write") {
        assert!(is_long(), "the table is written with TABOR_LONG=1");
        let built = PATHS.iter().filter(|path| path.is_built()).count();
        assert_eq!(
            here.len(),
            built,
            "the table is written where every path is here"
        );
        let rows: String = entries.iter().map(|entry| entry.line() + "\n").collect();
        fs::write(PAGE, [before, HEAD, &rows, after].concat()).expect("the page");
        return;
    }
    let written: Vec<Entry> = rows.lines().map(Entry::from_line).collect();
    let again = "TABOR_LONG=1 TABOR_HARD_CASES=write cargo test --release --test physics hard_cases writes it anew";
    for entry in entries {
        let found = written
            .iter()
            .find(|row| (&row.case, &row.path) == (&entry.case, &entry.path));
        let found = found.unwrap_or_else(|| panic!("the table lacks {entry:?}; {again}"));
        assert!(
            entry.agrees(found),
            "the table has {found:?}, here it is {entry:?}; {again}"
        );
    }
    for row in &written {
        let path = PATHS.iter().find(|path| path.name == row.path);
        let absent =
            path.is_some_and(|path| (path.is_built() && !path.is_here()) || waits(&row.case, path));
        let tried = entries
            .iter()
            .any(|entry| (&row.case, &row.path) == (&entry.case, &entry.path));
        assert!(
            tried || absent,
            "the table has {row:?}, which there is not; {again}"
        );
    }
}
