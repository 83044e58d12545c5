//! `curve.csv`: one row a step, on the disk as soon as the step ends.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use csv::StringRecord;

use super::csv_line::csv_line;
use super::error::{FRESH, OutputError};
use super::growing::GrowingTable;
#[cfg(feature = "cli")]
use crate::effect::Effect;
use crate::study::{Column, StepRow};

/// First line of `curve.csv` where no effect adds a column.
pub const HEADER: &str = "step,time,approach,mean_gap,force,mean_pressure,contact_area_fraction,attractive_area_fraction,elastic_energy,adhesive_energy,iterations,residual,converged,seconds,contact_area_fraction_corrected,state";

/// Columns that every curve has with their SI units; a share is shown in per cent.
#[cfg(feature = "cli")]
const UNITS: [(&str, &str); 11] = [
    ("time", "s"),
    ("approach", "m"),
    ("mean_gap", "m"),
    ("force", "N"),
    ("mean_pressure", "Pa"),
    ("contact_area_fraction", "%"),
    ("contact_area_fraction_corrected", "%"),
    ("attractive_area_fraction", "%"),
    ("elastic_energy", "J"),
    ("adhesive_energy", "J"),
    ("seconds", "s"),
];

/// The SI unit of a column in a table whose columns `is_there` knows, `%` for a share; empty where it has none.
#[cfg(feature = "cli")]
pub(crate) fn unit_of(column: &str, is_there: impl Fn(&str) -> bool) -> &'static str {
    let common = UNITS.iter().find(|(known, _)| *known == column);
    let unit = common.map(|(_, unit)| *unit);
    unit.or_else(|| Effect::unit_of_column(column, is_there))
        .unwrap_or_default()
}

/// Checksum (CRC-32) of a curve without rows.
pub(crate) const EMPTY_CHECKSUM: u32 = 0;

/// First line of `curve.csv` with the columns that effects add.
pub(crate) fn header(columns: &[Column]) -> String {
    let names = columns.iter().map(|column| format!(",{}", column.name()));
    names.fold(HEADER.to_owned(), |line, name| line + &name)
}

/// A curve as it stands on the disk: its whole rows.
#[derive(Debug)]
pub struct Curve {
    path: PathBuf,
    columns: Vec<Column>,
    rows: Vec<StepRow>,
    lines: Vec<String>,
}

impl Curve {
    /// Reads the curve at `path`, with these columns behind the others; empty where there is none. A row without its line end was being
    /// written when the run ended, and is left out.
    pub fn read(path: &Path, columns: Vec<Column>) -> Result<Curve, OutputError> {
        let mut curve = Curve {
            path: path.to_path_buf(),
            columns,
            rows: Vec::new(),
            lines: Vec::new(),
        };
        let bytes = match fs::read(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(curve),
            bytes => bytes.map_err(OutputError::write("read", path))?,
        };
        let text = String::from_utf8_lossy(&bytes);
        let mut lines = text
            .split_inclusive('\n')
            .filter(|line| line.ends_with('\n'));
        let head = header(&curve.columns);
        if lines.next().map(str::trim_end) != Some(head.as_str()) {
            return Err(OutputError::refused(
                path,
                format!("is not a curve that this version of tabor wrote; {FRESH}"),
            ));
        }
        let head: StringRecord = head.split(',').collect();
        for (index, line) in lines.enumerate() {
            let row = parse_row(line, &head, &curve.columns).filter(|row| row.step == index + 1);
            let row = row.ok_or_else(|| {
                let reason = format!(
                    "line {} is not row {} of a curve; {FRESH}",
                    index + 2,
                    index + 1
                );
                OutputError::refused(path, reason)
            })?;
            curve.rows.push(row);
            curve.lines.push(line.to_owned());
        }
        Ok(curve)
    }

    /// All whole rows.
    pub fn rows(&self) -> &[StepRow] {
        &self.rows
    }

    /// Refuses a curve with fewer rows than `finished`, or whose rows up to that are not those that the
    /// checksum was made of.
    pub fn expect(&self, finished: usize, checksum: u32) -> Result<(), OutputError> {
        let Some(rows) = self.rows.get(..finished) else {
            let reason = format!(
                "has {} whole rows where {finished} steps are finished; {FRESH}",
                self.rows.len()
            );
            return Err(OutputError::refused(&self.path, reason));
        };
        if self.checksum_of(rows).finalize() != checksum {
            let reason = format!("was changed since its steps were solved; {FRESH}");
            return Err(OutputError::refused(&self.path, reason));
        }
        Ok(())
    }

    fn checksum_of(&self, rows: &[StepRow]) -> crc32fast::Hasher {
        let mut found = crc32fast::Hasher::new();
        for row in rows {
            add_row(&mut found, row, &self.columns);
        }
        found
    }

    /// Resumes after the first `finished` rows, whose checksum is known; later rows are dropped.
    ///
    /// Refused where [`expect`](Curve::expect) refuses.
    pub fn resume(
        mut self,
        finished: usize,
        checksum: u32,
    ) -> Result<(CurveWriter, Vec<StepRow>), OutputError> {
        self.expect(finished, checksum)?;
        self.rows.truncate(finished);
        let found = self.checksum_of(&self.rows);
        let text = format!(
            "{}\n{}",
            header(&self.columns),
            self.lines[..finished].concat()
        );
        let writer = CurveWriter::write(&self.path, self.columns, text, found)?;
        Ok((writer, self.rows))
    }
}

/// Writes `curve.csv` row by row.
#[derive(Debug)]
pub struct CurveWriter {
    table: GrowingTable,
    columns: Vec<Column>,
    checksum: crc32fast::Hasher,
}

impl CurveWriter {
    /// Starts a curve at `path` with its head, these columns behind the others, and no rows.
    pub fn create(path: &Path, columns: Vec<Column>) -> Result<CurveWriter, OutputError> {
        let text = format!("{}\n", header(&columns));
        CurveWriter::write(path, columns, text, crc32fast::Hasher::new())
    }

    /// Creates or replaces the file at `path`, with rows of this checksum.
    fn write(
        path: &Path,
        columns: Vec<Column>,
        text: String,
        checksum: crc32fast::Hasher,
    ) -> Result<CurveWriter, OutputError> {
        Ok(CurveWriter {
            table: GrowingTable::create(path, text)?,
            columns,
            checksum,
        })
    }

    /// Writes the curve again from memory if another program removed or changed it; see
    /// [`GrowingTable::restore`].
    pub fn restore(&mut self, whole: bool) -> Result<Option<String>, OutputError> {
        self.table.restore(whole)
    }

    /// Appends one row and waits until it is on the disk.
    pub fn append(&mut self, row: &StepRow) -> Result<(), OutputError> {
        self.table.append(&format_row(row, &self.columns))?;
        add_row(&mut self.checksum, row, &self.columns);
        Ok(())
    }

    /// Checksum (CRC-32) of the rows so far but for their seconds, by which [`Curve::resume`]
    /// recognises them.
    pub fn checksum(&self) -> u32 {
        self.checksum.clone().finalize()
    }
}

/// One line of `curve.csv`, with its line end.
///
/// Numbers are the shortest that read back to the same bits; undefined values are empty.
pub fn format_row(row: &StepRow, columns: &[Column]) -> String {
    let number = |value: f64| format!("{value:?}");
    let optional = |value: Option<f64>| value.map(number).unwrap_or_default();
    let mut cells = vec![
        row.step.to_string(),
        optional(row.time),
        optional(row.approach),
        optional(row.mean_gap),
        number(row.force),
        number(row.mean_pressure),
        number(row.contact_area_fraction),
        number(row.attractive_area_fraction),
        number(row.elastic_energy),
        number(row.adhesive_energy),
        row.iterations.to_string(),
        number(row.residual),
        row.converged.to_string(),
        number(row.seconds),
        optional(row.contact_area_fraction_corrected),
        row.state.name().to_owned(),
    ];
    cells.extend(columns.iter().map(|column| optional(column.value(row))));
    csv_line(cells)
}

/// Rows of a curve as its lines, for another process of the same run.
pub(crate) fn rows_to_text(rows: &[StepRow], columns: &[Column]) -> String {
    rows.iter().map(|row| format_row(row, columns)).collect()
}

/// The rows of such lines; `None` if one is no row.
pub(crate) fn rows_from_text(text: &str, columns: &[Column]) -> Option<Vec<StepRow>> {
    let head = header(columns);
    let head: StringRecord = head.split(',').collect();
    let lines = text.split_inclusive('\n');
    lines.map(|line| parse_row(line, &head, columns)).collect()
}

/// Adds a row to a checksum. Its seconds are left out, so that the same run has the same one.
fn add_row(checksum: &mut crc32fast::Hasher, row: &StepRow, columns: &[Column]) {
    let row = StepRow {
        seconds: 0.0,
        ..row.clone()
    };
    checksum.update(format_row(&row, columns).as_bytes());
}

/// The row of a line that [`format_row`] made below this head.
fn parse_row(line: &str, head: &StringRecord, columns: &[Column]) -> Option<StepRow> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(line.as_bytes());
    let cells = reader.records().next()?.ok()?;
    if cells.len() != head.len() {
        return None;
    }
    let mut row: StepRow = cells.deserialize(Some(head)).ok()?;
    let behind = cells.len() - columns.len();
    for (column, cell) in columns.iter().zip(cells.iter().skip(behind)) {
        let value = match cell {
            "" => None,
            number => Some(number.parse().ok()?),
        };
        column.set(&mut row, value);
    }
    Some(row)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::State;
    use proptest::prelude::*;

    fn row(step: usize, value: f64) -> StepRow {
        StepRow {
            step,
            time: None,
            approach: Some(value),
            mean_gap: None,
            force: value,
            mean_pressure: -value,
            contact_area_fraction: 0.25,
            attractive_area_fraction: 0.0,
            elastic_energy: 1.5e-17,
            adhesive_energy: -2e-300,
            iterations: 12,
            residual: 3e-7,
            converged: true,
            seconds: 0.125,
            contact_area_fraction_corrected: None,
            state: State::Attracted,
            columns: Vec::new(),
        }
    }

    #[test]
    fn rows_are_on_the_disk_when_append_returns() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("curve.csv");
        let mut writer = CurveWriter::create(&path, Vec::new()).unwrap();
        writer.append(&row(1, 1e-9)).unwrap();
        assert_eq!(
            fs::read_to_string(&path).unwrap(),
            format!(
                "{HEADER}\n1,,1e-9,,1e-9,-1e-9,0.25,0.0,1.5e-17,-2e-300,12,3e-7,true,0.125,,attracted\n"
            )
        );
    }

    /// A curve of three rows and the start of a fourth, and the checksum after two.
    fn torn(path: &Path) -> u32 {
        let mut writer = CurveWriter::create(path, Vec::new()).unwrap();
        writer.append(&row(1, 1.0)).unwrap();
        writer.append(&row(2, 2.0)).unwrap();
        let checksum = writer.checksum();
        writer.append(&row(3, 3.0)).unwrap();
        writer.table.append("4,,0.5").unwrap();
        checksum
    }

    #[test]
    fn resuming_keeps_only_finished_rows() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("curve.csv");
        let checksum = torn(&path);
        let whole = fs::read_to_string(&path).unwrap();
        let curve = Curve::read(&path, Vec::new()).unwrap();
        assert_eq!(curve.rows(), [row(1, 1.0), row(2, 2.0), row(3, 3.0)]);
        let (mut writer, rows) = curve.resume(2, checksum).unwrap();
        assert_eq!(rows, [row(1, 1.0), row(2, 2.0)]);
        assert_eq!(writer.checksum(), checksum);
        writer.append(&row(3, 3.0)).unwrap();
        let resumed = fs::read_to_string(&path).unwrap();
        assert_eq!(format!("{resumed}4,,0.5"), whole);
    }

    fn refused<T>(outcome: Result<T, OutputError>) -> bool {
        matches!(outcome, Err(OutputError::Refused { .. }))
    }

    #[test]
    fn missing_and_changed_rows_are_refused() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("curve.csv");
        assert_eq!(crc32fast::Hasher::new().finalize(), EMPTY_CHECKSUM);
        // No curve yet: fine where no step is finished.
        assert!(refused(
            Curve::read(&path, Vec::new()).unwrap().resume(1, 0)
        ));
        assert!(!path.exists());
        Curve::read(&path, Vec::new())
            .unwrap()
            .resume(0, 0)
            .unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), format!("{HEADER}\n"));

        let checksum = torn(&path);
        assert!(refused(
            Curve::read(&path, Vec::new()).unwrap().resume(4, checksum)
        ));
        let changed = fs::read_to_string(&path).unwrap().replace("2.0", "2.5");
        fs::write(&path, changed).unwrap();
        assert!(refused(
            Curve::read(&path, Vec::new()).unwrap().resume(2, checksum)
        ));
    }

    #[test]
    fn a_foreign_file_is_not_resumed() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("curve.csv");
        for text in [
            "a,b\n1,2\n",
            &format!("{HEADER}\n1,2\n"),
            &format!("{HEADER}\n{}", format_row(&row(2, 1.0), &[])),
        ] {
            fs::write(&path, text).unwrap();
            assert!(refused(Curve::read(&path, Vec::new())), "{text}");
        }
    }

    proptest! {
        #[test]
        fn numbers_read_back_bit_for_bit(value in proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL | proptest::num::f64::ZERO) {
            let line = format_row(&row(7, value), &[]);
            let cells: Vec<&str> = line.trim_end().split(',').collect();
            prop_assert_eq!(cells.len(), HEADER.split(',').count());
            prop_assert_eq!(cells[4].parse::<f64>().unwrap().to_bits(), value.to_bits());
            let head = HEADER.split(',').collect();
            let read = parse_row(&line, &head, &[]).unwrap();
            prop_assert_eq!(read.mean_pressure.to_bits(), (-value).to_bits());
            prop_assert_eq!(read, row(7, value));
        }
    }
}
