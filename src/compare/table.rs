//! `compare.csv`, on the disk row by row.

use std::path::Path;

use super::State;
use crate::clock::Clock;
use crate::output::csv_line::{csv_line, csv_number};
use crate::output::{FolderLock, GrowingTable, OutputError, expect_table};

/// First line of `compare.csv`.
const HEADER: &str = "model,mean_pressure,contact_area_fraction,mean_gap,adhesive_pressure,pull_off_pressure,seconds,within_range,limit,branch";

/// Contact area over nominal area that no rounding exceeds.
const FULL: f64 = 1.0 + 1e-9;
/// Relative difference of a load from pull-off by rounding.
const ROUNDING: f64 = 1e-6;

/// A row of the comparison.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Row {
    /// Name of the model.
    pub model: &'static str,
    /// Its results.
    pub state: State,
    /// Greatest tension that the model carries, Pa, positive.
    pub pull_off: Option<f64>,
    /// Seconds since the model's row before.
    pub seconds: f64,
    /// Why the model is out of its range here.
    pub limit: Option<&'static str>,
    /// The branch that the row is on: `pull-off`, the state of greatest tension, or `loading` or `unloading`, as the
    /// load rises or falls to it.
    pub branch: &'static str,
}

/// The comparison while it is written.
pub(super) struct Table {
    table: GrowingTable,
    lock: FolderLock,
    rows: Vec<Row>,
    model: &'static str,
    clock: Clock,
}

impl Table {
    /// Starts `compare.csv` in a folder, in place of an earlier one.
    pub fn create(folder: &Path) -> Result<Table, OutputError> {
        let path = folder.join("compare.csv");
        expect_table(&path, HEADER)?;
        let lock = FolderLock::take(&folder.join(FolderLock::HIDDEN), folder)?;
        Ok(Table {
            table: GrowingTable::create(&path, format!("{HEADER}\n"))?,
            lock,
            rows: Vec::new(),
            model: "",
            clock: Clock::start(),
        })
    }

    /// The following rows belong to this model.
    pub fn begin(&mut self, model: &'static str) {
        self.model = model;
        self.clock = Clock::start();
    }

    /// Adds a row of the current model and waits until it is on the disk.
    pub fn add(
        &mut self,
        state: State,
        pull_off: Option<f64>,
        limit: Option<&'static str>,
    ) -> Result<(), OutputError> {
        let too_large = state.contact_area_fraction.is_some_and(|area| area > FULL);
        let (state, limit) = if too_large {
            let state = State {
                contact_area_fraction: None,
                ..state
            };
            (state, limit.or(Some("contact area above 100 %")))
        } else {
            (state, limit)
        };
        let row = Row {
            model: self.model,
            state,
            pull_off,
            seconds: self.clock.seconds(),
            limit,
            branch: self.branch(state.mean_pressure, pull_off),
        };
        self.clock = Clock::start();
        let line = csv_line([
            row.model.to_owned(),
            csv_number(Some(state.mean_pressure)),
            csv_number(state.contact_area_fraction),
            csv_number(state.mean_gap),
            csv_number(state.adhesive_pressure),
            csv_number(pull_off),
            format!("{:.6}", row.seconds),
            limit.is_none().to_string(),
            limit.unwrap_or_default().to_owned(),
            row.branch.to_owned(),
        ]);
        self.table.append(&line)?;
        self.rows.push(row);
        Ok(())
    }

    fn branch(&self, load: f64, pull_off: Option<f64>) -> &'static str {
        let before = self.rows.last().filter(|row| row.model == self.model);
        match (before, pull_off) {
            (None, Some(tension)) if tension > 0.0 && load <= -tension * (1.0 - ROUNDING) => {
                "pull-off"
            }
            (Some(before), _) if load < before.state.mean_pressure => "unloading",
            _ => "loading",
        }
    }

    /// All rows, once they are in the file, with warnings about it.
    pub fn into_rows(mut self) -> Result<(Vec<Row>, Vec<String>), OutputError> {
        let unheld = self.lock.warning().map(str::to_owned);
        let notes = unheld
            .into_iter()
            .chain(self.table.restore(true)?)
            .collect();
        Ok((self.rows, notes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_say_their_branch_and_no_area_is_above_the_nominal_one() {
        let place = tempfile::tempdir().unwrap();
        let mut table = Table::create(place.path()).unwrap();
        let state = |mean_pressure: f64, area: f64| State {
            mean_pressure,
            contact_area_fraction: Some(area),
            ..State::default()
        };
        for model in ["one", "other"] {
            table.begin(model);
            for (load, area) in [(-2.0, 0.1), (1.0, 0.5), (3.0, 1.2), (2.0, 1.0)] {
                table.add(state(load, area), Some(2.0), None).unwrap();
            }
        }
        let (rows, _) = table.into_rows().unwrap();
        for rows in rows.chunks(4) {
            let branches: Vec<&str> = rows.iter().map(|row| row.branch).collect();
            assert_eq!(branches, ["pull-off", "loading", "loading", "unloading"]);
            assert_eq!(rows[2].state.contact_area_fraction, None);
            assert_eq!(rows[2].limit, Some("contact area above 100 %"));
            assert_eq!(
                (rows[3].state.contact_area_fraction, rows[3].limit),
                (Some(1.0), None)
            );
        }
        let text = std::fs::read_to_string(place.path().join("compare.csv")).unwrap();
        assert!(
            text.lines().nth(4).unwrap().ends_with(",true,,unloading"),
            "{text}"
        );
    }
}
