//! `curve.csv`: one row a step, on the disk as soon as the step ends.

use std::fmt::Write as _;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use super::error::OutputError;
use super::folder::write_atomically;
use crate::study::StepRow;

/// First line of `curve.csv`.
pub const HEADER: &str = "step,time,approach,mean_gap,force,mean_pressure,contact_area_fraction,attractive_area_fraction,elastic_energy,adhesive_energy,iterations,residual,converged,seconds,contact_area_fraction_corrected,state";

/// Writes `curve.csv` row by row.
#[derive(Debug)]
pub struct CurveWriter {
    path: PathBuf,
    file: File,
}

impl CurveWriter {
    /// Starts a curve at `path` with its head and no rows.
    pub fn create(path: &Path) -> Result<CurveWriter, OutputError> {
        write_atomically(path, format!("{HEADER}\n").as_bytes())?;
        CurveWriter::append_to(path)
    }

    /// Goes on with the curve at `path` after its first `rows` rows; later ones are dropped.
    ///
    /// Refused where the file is not a curve of this version or has fewer whole rows.
    pub fn resume(path: &Path, rows: usize) -> Result<CurveWriter, OutputError> {
        let bytes = match fs::read(path) {
            // A run that ended before its first step may not have come to its curve.
            Err(error) if error.kind() == io::ErrorKind::NotFound && rows == 0 => {
                return CurveWriter::create(path);
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                let reason = format!("is missing, where {rows} steps are finished");
                return Err(OutputError::refused(path, reason));
            }
            bytes => bytes.map_err(OutputError::write("read", path))?,
        };
        let text = String::from_utf8_lossy(&bytes);
        let mut lines = text
            .split_inclusive('\n')
            .filter(|line| line.ends_with('\n'));
        if lines.next().map(str::trim_end) != Some(HEADER) {
            return Err(OutputError::refused(
                path,
                "is not a curve that this version of tabor wrote",
            ));
        }
        let kept: Vec<&str> = lines.take(rows).collect();
        if kept.len() < rows {
            return Err(OutputError::refused(
                path,
                format!(
                    "has {} whole rows where {rows} steps are finished",
                    kept.len()
                ),
            ));
        }
        let text = format!("{HEADER}\n{}", kept.concat());
        write_atomically(path, text.as_bytes())?;
        CurveWriter::append_to(path)
    }

    fn append_to(path: &Path) -> Result<CurveWriter, OutputError> {
        let file = OpenOptions::new()
            .append(true)
            .open(path)
            .map_err(OutputError::write("open", path))?;
        Ok(CurveWriter {
            path: path.to_path_buf(),
            file,
        })
    }

    /// Appends one row and waits until it is on the disk.
    pub fn append(&mut self, row: &StepRow) -> Result<(), OutputError> {
        // One write a row, so that a reader or a crash meets whole rows.
        self.file
            .write_all(format_row(row).as_bytes())
            .and_then(|()| self.file.sync_data())
            .map_err(OutputError::write("write", &self.path))
    }
}

/// One line of `curve.csv`, with its line end.
///
/// Numbers are the shortest that read back to the same bits; what is not defined is empty.
pub fn format_row(row: &StepRow) -> String {
    let optional = |value: Option<f64>| value.map(|value| format!("{value:?}")).unwrap_or_default();
    let mut line = String::new();
    write!(
        line,
        "{},{},{},{},{:?},{:?},{:?},{:?},{:?},{:?},{},{:?},{},{:?},{},{}",
        row.step,
        optional(row.time),
        optional(row.approach),
        optional(row.mean_gap),
        row.force,
        row.mean_pressure,
        row.contact_area_fraction,
        row.attractive_area_fraction,
        row.elastic_energy,
        row.adhesive_energy,
        row.iterations,
        row.residual,
        row.converged,
        row.seconds,
        optional(row.contact_area_fraction_corrected),
        row.state.name(),
    )
    .expect("writing to a string cannot fail");
    line.push('\n');
    line
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
        }
    }

    #[test]
    fn rows_are_on_the_disk_when_append_returns() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("curve.csv");
        let mut writer = CurveWriter::create(&path).unwrap();
        writer.append(&row(1, 1e-9)).unwrap();
        assert_eq!(
            fs::read_to_string(&path).unwrap(),
            format!(
                "{HEADER}\n1,,1e-9,,1e-9,-1e-9,0.25,0.0,1.5e-17,-2e-300,12,3e-7,true,0.125,,attracted\n"
            )
        );
    }

    #[test]
    fn resuming_keeps_the_finished_rows_only() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("curve.csv");
        let mut writer = CurveWriter::create(&path).unwrap();
        for step in 1..=3 {
            writer.append(&row(step, step as f64)).unwrap();
        }
        // A row cut short by a crash does not count.
        writer.file.write_all(b"4,,0.5").unwrap();
        let whole = fs::read_to_string(&path).unwrap();
        assert!(matches!(
            CurveWriter::resume(&path, 4),
            Err(OutputError::Refused { .. })
        ));
        let mut writer = CurveWriter::resume(&path, 2).unwrap();
        writer.append(&row(3, 3.0)).unwrap();
        let resumed = fs::read_to_string(&path).unwrap();
        assert_eq!(format!("{resumed}4,,0.5"), whole);
    }

    #[test]
    fn a_missing_curve_is_started_only_where_no_step_is_finished() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("curve.csv");
        assert!(matches!(
            CurveWriter::resume(&path, 1),
            Err(OutputError::Refused { .. })
        ));
        CurveWriter::resume(&path, 0).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), format!("{HEADER}\n"));
    }

    #[test]
    fn a_foreign_file_is_not_resumed() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("curve.csv");
        fs::write(&path, "a,b\n1,2\n").unwrap();
        assert!(matches!(
            CurveWriter::resume(&path, 1),
            Err(OutputError::Refused { .. })
        ));
    }

    proptest! {
        #[test]
        fn numbers_read_back_bit_for_bit(value in proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL | proptest::num::f64::ZERO) {
            let line = format_row(&row(7, value));
            let cells: Vec<&str> = line.trim_end().split(',').collect();
            prop_assert_eq!(cells.len(), HEADER.split(',').count());
            prop_assert_eq!(cells[4].parse::<f64>().unwrap().to_bits(), value.to_bits());
        }
    }
}
