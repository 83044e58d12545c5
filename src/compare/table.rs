//! `compare.csv`, on the disk row by row.

use std::path::Path;

use super::State;
use crate::clock::Clock;
use crate::output::csv_line::{csv_line, csv_number};
use crate::output::{FolderLock, GrowingTable, OutputError, expect_table};

/// First line of `compare.csv`.
const HEADER: &str = "model,mean_pressure,contact_area_fraction,mean_gap,adhesive_pressure,pull_off_pressure,seconds,within_range,limit";

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
        let row = Row {
            model: self.model,
            state,
            pull_off,
            seconds: self.clock.seconds(),
            limit,
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
        ]);
        self.table.append(&line)?;
        self.rows.push(row);
        Ok(())
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
