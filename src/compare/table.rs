//! `compare.csv`, on the disk row by row.

use std::fs;
use std::path::Path;

use super::State;
use crate::clock::Clock;
use crate::output::{FolderLock, GrowingTable, OutputError};

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
        let refused = |reason: &str| OutputError::Refused {
            path: path.clone(),
            reason: reason.to_owned(),
        };
        if folder.is_file() {
            return Err(refused("its folder is a file; name a folder"));
        }
        if fs::read(&path).is_ok_and(|old| !old.starts_with(HEADER.as_bytes())) {
            return Err(refused(
                "is not a table that tabor wrote; name another folder",
            ));
        }
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
        let cell = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:e}"));
        let line = format!(
            "{},{:e},{},{},{},{},{:.6},{},{}\n",
            row.model,
            state.mean_pressure,
            cell(state.contact_area_fraction),
            cell(state.mean_gap),
            cell(state.adhesive_pressure),
            cell(pull_off),
            row.seconds,
            limit.is_none(),
            limit.unwrap_or_default()
        );
        self.table.append(&line)?;
        self.rows.push(row);
        Ok(())
    }

    /// All rows, once they are in the file, with warnings about it.
    pub fn into_rows(mut self) -> Result<(Vec<Row>, Vec<String>), OutputError> {
        let unheld = self.lock.warning().map(str::to_owned);
        let notes = unheld.into_iter().chain(self.table.mend(true)?).collect();
        Ok((self.rows, notes))
    }
}
