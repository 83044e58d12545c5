//! Reference tables: CSV with `#` comments and a head.

use std::collections::HashMap;
use std::path::PathBuf;

use crate::shared::trials::{expect_ignored, ignore, tests};

/// A table by column; text cells are NaN.
pub struct Table {
    head: HashMap<String, usize>,
    rows: Vec<Vec<String>>,
}

impl Table {
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    pub fn number(&self, row: usize, column: &str) -> f64 {
        self.text(row, column).parse().unwrap_or(f64::NAN)
    }

    pub fn text(&self, row: usize, column: &str) -> &str {
        &self.rows[row][self.head[column]]
    }

    /// The row whose cell of a column is this number.
    pub fn find(&self, column: &str, value: f64) -> Option<usize> {
        (0..self.len()).find(|&row| (self.number(row, column) - value).abs() < 1e-9 * value)
    }

    pub fn column(&self, column: &str) -> Vec<f64> {
        (0..self.len())
            .map(|row| self.number(row, column))
            .collect()
    }
}

/// The folder of tables: the repository's, or the one that `TABOR_REFERENCE` names.
pub fn folder() -> PathBuf {
    match std::env::var_os("TABOR_REFERENCE") {
        Some(folder) => PathBuf::from(folder),
        None => PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/reference"),
    }
}

/// Reads a table; the test that asks for one that is not there is ignored.
pub fn table(name: &str) -> Table {
    let path = folder().join(name);
    let Ok(text) = std::fs::read_to_string(&path) else {
        ignore(format!("no table {}", path.display()));
    };
    let mut lines = text
        .lines()
        .filter(|line| !line.starts_with('#') && !line.trim().is_empty());
    let head = lines
        .next()
        .unwrap_or_else(|| panic!("{} is empty", path.display()))
        .split(',')
        .enumerate()
        .map(|(i, name)| (name.trim().to_string(), i))
        .collect();
    let rows = lines
        .map(|line| {
            line.split(',')
                .map(|cell| cell.trim().to_string())
                .collect()
        })
        .collect();
    Table { head, rows }
}

/// The numbers in the names `prefixNUMBER.csv` of the folder, in order; the test that asks is ignored where
/// there are none.
pub fn parameters(prefix: &str) -> Vec<(f64, String)> {
    let mut found: Vec<(f64, String)> = std::fs::read_dir(folder())
        .map(|entries| {
            entries
                .flatten()
                .filter_map(|entry| {
                    let name = entry.file_name().into_string().ok()?;
                    let number = name
                        .strip_prefix(prefix)?
                        .strip_suffix(".csv")?
                        .parse()
                        .ok()?;
                    Some((number, name))
                })
                .collect()
        })
        .unwrap_or_default();
    if found.is_empty() {
        ignore(format!("no table {}", folder().join(prefix).display()));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found
}

/// |d(of)/d(approach)| of a curve at a row; `approach` names its column.
pub fn slope(curve: &Table, row: usize, of: &str, approach: &str) -> f64 {
    let (before, after) = (row.saturating_sub(1), (row + 1).min(curve.len() - 1));
    let change = |column: &str| curve.number(after, column) - curve.number(before, column);
    (change(of) / change(approach)).abs()
}

/// All rows under TABOR_LONG=1, else about `count` of them.
pub fn thinned(rows: Vec<usize>, count: usize) -> Vec<usize> {
    let long = std::env::var_os("TABOR_LONG").is_some();
    let every = if long {
        1
    } else {
        rows.len().div_ceil(count).max(1)
    };
    rows.into_iter().step_by(every).collect()
}

fn a_test_without_its_table_is_ignored_with_its_reason() {
    let elsewhere = [("TABOR_REFERENCE", "/nonexistent")];
    expect_ignored(
        "maugis_dugdale::curves",
        &elsewhere,
        "no table /nonexistent/md_special_points.csv",
    );
}

tests![a_test_without_its_table_is_ignored_with_its_reason];
