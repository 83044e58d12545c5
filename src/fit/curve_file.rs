//! Force curves: text with one row a point and the columns named in the header, or a file of an instrument.

use std::fs;
use std::io::Read;
use std::path::Path;

use super::columns::{CurveColumns, Head, number};
use super::error::FitError;
#[cfg(feature = "images")]
use super::jpk;
use super::nanoscope;
use crate::units::in_range;

/// Largest file that is read.
pub const MOST_BYTES: u64 = 256 << 20;
/// Fewest rows: twice the parameters of the most general model.
pub const LEAST_ROWS: usize = 10;

/// One point of a curve, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Approach, positive closer, m.
    pub approach: f64,
    /// Force, positive in compression, N.
    pub force: f64,
}

/// A force curve in the order of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForceCurve {
    /// Its points.
    pub samples: Vec<Sample>,
    /// Skipped lines with a missing value, from 1.
    pub incomplete: Vec<usize>,
    /// Skipped lines marked as not converged, from 1.
    pub unconverged: Vec<usize>,
    /// Time of each point, s; empty where it is not known.
    pub times: Vec<f64>,
    /// Why a column of the name time is not read.
    pub no_time: Option<String>,
    /// Spring constant of the cantilever, N/m, where it is known.
    pub spring: Option<f64>,
    /// Whether positions of its base were measured, and the approaches are these less the force over the spring constant.
    pub has_positions: bool,
    /// Whether a sensitivity was given for a table without a deflection in volts.
    pub sensitivity_unused: bool,
}

/// An optional column that tabor writes.
const CONVERGED: &str = "converged";

impl ForceCurve {
    /// Reads a file with the columns approach and force.
    ///
    /// # Errors
    /// A file that cannot be read, with the line; fewer than ten rows; columns that never change.
    pub fn read(path: &Path) -> Result<Self, FitError> {
        ForceCurve::read_columns(path, &CurveColumns::default())
    }

    /// Reads a file with columns of an instrument.
    ///
    /// # Errors
    /// As [`ForceCurve::read`]; a column that is not there, or a spring constant or a sensitivity that it needs.
    pub fn read_columns(path: &Path, columns: &CurveColumns) -> Result<Self, FitError> {
        let unreadable = |cause| FitError::Unreadable {
            path: name(path),
            cause,
        };
        let metadata = fs::metadata(path).map_err(unreadable)?;
        if !metadata.is_file() {
            // A device never ends, and a pipe has no known length.
            return Err(FitError::NotRegular { path: name(path) });
        }
        let bytes = metadata.len();
        if bytes > MOST_BYTES {
            return Err(FitError::TooLarge {
                path: name(path),
                bytes,
            });
        }
        let mut text = Vec::new();
        // If the file grows while it is read, the extra bytes are ignored.
        let file = fs::File::open(path).map_err(unreadable)?;
        file.take(bytes)
            .read_to_end(&mut text)
            .map_err(unreadable)?;
        Self::parse(&text, path, columns)
    }

    /// Reads the bytes of a file; `path` is for messages. Files of JPK (with the feature `images`) and Nanoscope are known by
    /// their first bytes.
    ///
    /// Columns are separated by commas, semicolons or tabs, whichever the header has (a first line `sep=;` is skipped); with the last
    /// two a comma may be the decimal mark. A table without a header may be separated by blanks, and its columns
    /// are chosen by their numbers. Lines that begin with `#` are comments.
    ///
    /// # Errors
    /// As [`ForceCurve::read_columns`].
    pub fn parse(bytes: &[u8], path: &Path, columns: &CurveColumns) -> Result<Self, FitError> {
        if let Some(read) = instrument(bytes) {
            let curve = read(bytes, path, columns)?;
            curve.check(path)?;
            return Ok(curve);
        }
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        let text = std::str::from_utf8(bytes)
            .ok()
            .filter(|text| !text.contains('\0'))
            .ok_or_else(|| FitError::NotText { path: name(path) })?;
        let mut lines = (1..).zip(text.lines()).filter(|(_, line)| {
            let text = line.trim_start();
            !text.is_empty() && !text.starts_with('#')
        });
        let no_head = || FitError::NoHead { path: name(path) };
        let mut first = lines.next();
        if first.is_some_and(|(_, line)| names_separator(line)) {
            first = lines.next();
        }
        let (line, whole_head) = first.ok_or_else(no_head)?;
        let head = whole_head.trim();
        let separator = [';', '\t', ',']
            .into_iter()
            .find(|s| split(head, *s).len() > 1);
        let separator = separator.unwrap_or(if head.contains(' ') { ' ' } else { ',' });
        let names: Vec<&str> = split(head, separator);
        let is_number = |name: &&str| number(name, separator).is_some();
        let has_head = !names.iter().any(is_number);
        // Numbers name columns only where all of them do.
        let are_numbered = |columns: &CurveColumns| {
            let mut choices = columns.choices.iter();
            columns.choices.len() >= 2
                && choices.all(|choice| choice.column.parse::<usize>().is_ok())
        };
        if !has_head && !are_numbered(columns) {
            return Err(no_head());
        }
        // A header of words between single blanks cannot be told from words of several parts.
        let separator = if has_head && separator == ' ' {
            ','
        } else {
            separator
        };
        let names = match (has_head, separator) {
            // Tables of pandas begin with a column without a name.
            (true, '\t') => split(whole_head.trim_end(), separator),
            (true, _) => split(head, separator),
            // Empty names, so that no number is taken for the name of a column.
            (false, _) => vec![""; names.len()],
        };
        let head_row = (!has_head).then_some((line, head));
        let head = Head { path, line, names };
        let (spring, sensitivity) = (columns.spring, columns.sensitivity);
        let columns = head.columns(columns)?;
        let converged = head.names.iter().position(|name| *name == CONVERGED);

        let mut curve = ForceCurve {
            spring,
            has_positions: columns.has_positions(),
            sensitivity_unused: sensitivity.is_some() && !columns.in_volts(),
            no_time: columns.no_time.clone(),
            ..ForceCurve::default()
        };
        for (line, text) in head_row.into_iter().chain(lines) {
            let mut cells = split(text.trim(), separator);
            if separator == '\t' && cells.len() < head.names.len() {
                // Cells at the ends of the line are empty.
                cells = split(text, separator);
                while cells.len() > head.names.len() && cells.last() == Some(&"") {
                    cells.pop();
                }
            }
            if cells.len() != head.names.len() {
                return Err(FitError::Ragged {
                    path: name(path),
                    line,
                    found: cells.len(),
                    expected: head.names.len(),
                });
            }
            if converged.is_some_and(|at| cells[at].eq_ignore_ascii_case("false")) {
                curve.unconverged.push(line);
                continue;
            }
            match columns.sample(path, line, &cells, separator)? {
                Some((approach, force)) => {
                    curve.samples.push(Sample { approach, force });
                    curve.times.extend(columns.time(&cells, separator));
                }
                None => curve.incomplete.push(line),
            }
        }
        curve.check(path)?;
        Ok(curve)
    }

    fn check(&self, path: &Path) -> Result<(), FitError> {
        let extreme = |column, of: fn(&Sample) -> f64| {
            // Only the largest magnitude matters; beside it a small number may be arbitrarily
            // small.
            let largest = self
                .samples
                .iter()
                .map(of)
                .fold(0.0, |most: f64, value| most.max(value.abs()));
            if in_range(largest) {
                return Ok(());
            }
            Err(FitError::Extreme {
                path: name(path),
                column,
                largest,
            })
        };
        if self.samples.len() < LEAST_ROWS {
            return Err(FitError::TooFewRows {
                path: name(path),
                rows: self.samples.len(),
            });
        }
        extreme("approach", |sample| sample.approach)?;
        extreme("force", |sample| sample.force)?;
        let first = self.samples[0];
        let constant = |column, same: fn(&Sample, &Sample) -> bool| {
            if self.samples.iter().all(|sample| same(sample, &first)) {
                return Err(FitError::Constant {
                    path: name(path),
                    column,
                });
            }
            Ok(())
        };
        constant("approach", |a, b| a.approach == b.approach)?;
        constant("force", |a, b| a.force == b.force)
    }
}

/// Reads a file of an instrument.
type Reader = fn(&[u8], &Path, &CurveColumns) -> Result<ForceCurve, FitError>;

/// The reader of a file that begins as those of an instrument do.
fn instrument(bytes: &[u8]) -> Option<Reader> {
    if bytes.starts_with(nanoscope::MAGIC) {
        return Some(nanoscope::read);
    }
    #[cfg(feature = "images")]
    if bytes.starts_with(jpk::MAGIC) {
        return Some(jpk::read);
    }
    None
}

/// The name of a file in messages.
pub(super) fn name(path: &Path) -> String {
    path.display().to_string()
}

/// Whether a first line tells a spreadsheet what separates the cells, as in `sep=;`.
fn names_separator(line: &str) -> bool {
    let text = line.trim().trim_matches('"').to_ascii_lowercase();
    let separator = text.strip_prefix("sep=");
    separator.is_some_and(|separator| separator.chars().count() <= 1)
}

/// The cells of a line. A cell in quotes may hold the separator; a quote within it is doubled.
fn split(line: &str, separator: char) -> Vec<&str> {
    if separator == ' ' {
        return line.split_whitespace().map(unquoted).collect();
    }
    let mut cells = Vec::new();
    let mut rest = line;
    loop {
        let begin = rest.len() - rest.trim_start_matches(' ').len();
        let after_quotes = end_of_quotes(&rest[begin..]).map_or(0, |end| begin + end);
        let Some(length) = rest[after_quotes..].find(separator) else {
            cells.push(unquoted(rest));
            return cells;
        };
        let (cell, next) = rest.split_at(after_quotes + length);
        cells.push(unquoted(cell));
        rest = &next[separator.len_utf8()..];
    }
}

/// Where a text in quotes ends, behind its last quote; `None` if it does not begin with one, or never ends.
fn end_of_quotes(text: &str) -> Option<usize> {
    let inner = text.strip_prefix('"')?;
    let mut from = 0;
    loop {
        let quote = from + inner[from..].find('"')?;
        if !inner[quote + 1..].starts_with('"') {
            return Some(quote + 2);
        }
        from = quote + 2;
    }
}

fn unquoted(cell: &str) -> &str {
    cell.trim().trim_matches('"').trim()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(text: &str) -> Vec<(f64, f64)> {
        // Rows that fill up the least number; they come last.
        let separator = if text.contains(';') { ";" } else { "," };
        let columns = text
            .lines()
            .next()
            .map_or(2, |head| head.split(separator).count());
        let filler = vec!["7"; columns].join(separator) + "\n";
        let text = format!("{text}{}", filler.repeat(LEAST_ROWS));
        let curve = ForceCurve::parse(
            text.as_bytes(),
            Path::new("curve.csv"),
            &CurveColumns::default(),
        )
        .unwrap();
        let pairs = curve.samples.iter().map(|s| (s.approach, s.force));
        pairs.take(curve.samples.len() - LEAST_ROWS).collect()
    }

    /// Spreadsheets write such a line; it was taken for the header.
    #[test]
    fn a_line_that_names_the_separator_is_no_header() {
        for (first, separator) in [("sep=;", ';'), ("SEP=,\r", ','), ("\"sep=\t\"", '\t')] {
            let rows = format!("1{separator}2\n").repeat(LEAST_ROWS) + &format!("3{separator}4\n");
            let text = format!("{first}\napproach [nm]{separator}force [nN]\n{rows}");
            let columns = CurveColumns::default();
            let curve = ForceCurve::parse(text.as_bytes(), Path::new("curve.csv"), &columns);
            assert_eq!(curve.unwrap().samples.len(), LEAST_ROWS + 1, "{first}");
        }
    }

    #[test]
    fn cells_in_quotes_may_hold_separators() {
        let text = "\"note, of; day\",approach,force\n\"a, \"\"b\"\", c\",1,2\n , 3 ,\"4\"\n\"unclosed,5,6\n";
        assert_eq!(
            split(text.lines().next().unwrap(), ','),
            ["note, of; day", "approach", "force"]
        );
        let rows: String = text.to_owned() + &"x,7,7\n".repeat(LEAST_ROWS);
        let curve = ForceCurve::parse(
            rows.as_bytes(),
            Path::new("curve.csv"),
            &CurveColumns::default(),
        )
        .unwrap();
        let pairs: Vec<(f64, f64)> = curve
            .samples
            .iter()
            .map(|s| (s.approach, s.force))
            .collect();
        assert_eq!(pairs[..3], [(1.0, 2.0), (3.0, 4.0), (5.0, 6.0)]);
        assert_eq!(split("\"\"", ','), [""]);
        assert_eq!(split("\"", ','), [""]);
        assert_eq!(split("\"a\"b,c", ','), ["a\"b", "c"]);
    }

    #[test]
    fn units_separators_and_decimal_marks() {
        let close = |got: Vec<(f64, f64)>, expected: [(f64, f64); 2]| {
            assert_eq!(got.len(), 2);
            for (got, expected) in got.into_iter().zip(expected) {
                assert!(
                    (got.0 - expected.0).abs() <= 1e-15 * expected.0.abs(),
                    "{got:?}"
                );
                assert!(
                    (got.1 - expected.1).abs() <= 1e-15 * expected.1.abs(),
                    "{got:?}"
                );
            }
        };
        let expected = [(-1.5e-9, 2e-9), (0.25e-9, -3e-9)];
        close(
            samples("approach,force\n-1.5e-9,2e-9\n.25E-9,-3e-9\n"),
            expected,
        );
        close(
            samples("approach [nm], force [nN]\n# a comment\n-1.5, 2\n\n0.25, -3.0\n"),
            expected,
        );
        close(
            samples("time;Force (pN);Approach (um)\n0;2000;-0,0015\n1;-3e3;2,5e-4\n"),
            expected,
        );
    }

    #[test]
    fn missing_values_are_left_out_and_counted() {
        let mut text = String::from("approach,force,converged\n,1,true\n1,nan,true\n2,3,false\n");
        for row in 0..LEAST_ROWS {
            text += &format!("{row},{row},true\n");
        }
        let curve = ForceCurve::parse(
            text.as_bytes(),
            Path::new("curve.csv"),
            &CurveColumns::default(),
        )
        .unwrap();
        assert_eq!(curve.incomplete, [2, 3]);
        assert_eq!(curve.unconverged, [4]);
        assert_eq!(curve.samples.len(), LEAST_ROWS);
        // As pandas writes it.
        let text = text.replace("false", "False");
        let again = ForceCurve::parse(
            text.as_bytes(),
            Path::new("curve.csv"),
            &CurveColumns::default(),
        );
        assert_eq!(again.unwrap(), curve);
    }

    /// In a line of tabs an empty cell at either end is a cell, but for one after a last tab.
    #[test]
    fn tabs_at_the_ends_of_a_line() {
        let rows = "1\t2\t\n".repeat(LEAST_ROWS);
        for (text, points, incomplete) in [
            (format!("approach\tforce\tnote\n{rows}"), 10, vec![]),
            (
                format!("approach\tforce\t\n\t2\t\n{rows}3\t\t\n"),
                10,
                vec![2, 13],
            ),
            (
                format!("approach\tforce\n\t2\n{rows}3\t\n"),
                10,
                vec![2, 13],
            ),
            (
                format!("\tapproach\tforce\n0\t1\t2\n{}", "1\t1\t2\n".repeat(10)),
                11,
                vec![],
            ),
        ] {
            // The same value in every row is no curve to fit.
            let text = text.replacen("1\t2", "2\t3", 1);
            let curve = ForceCurve::parse(
                text.as_bytes(),
                Path::new("curve.txt"),
                &CurveColumns::default(),
            )
            .unwrap();
            assert_eq!(curve.samples.len(), points, "{text:?}");
            assert_eq!(curve.incomplete, incomplete, "{text:?}");
        }
    }
}
