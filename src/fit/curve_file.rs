//! Force curves as text: one row a point, the columns named in the header.

use std::fs;
use std::io::Read;
use std::path::Path;

use super::error::FitError;
use crate::units::{Dimension, in_range, quoted, unit_factor};

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
}

/// A required column: its name, its dimension, and a unit for messages.
const APPROACH: (&str, Dimension, &str) = ("approach", Dimension::Length, "[nm]");
const FORCE: (&str, Dimension, &str) = ("force", Dimension::Force, "[nN]");
/// An optional column that tabor writes.
const CONVERGED: &str = "converged";

impl ForceCurve {
    /// Reads a file.
    ///
    /// # Errors
    /// A file that cannot be read, with the line; fewer than ten rows; columns that never change.
    pub fn read(path: &Path) -> Result<Self, FitError> {
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
        Self::parse(&text, path)
    }

    /// Reads the bytes of a file; `path` is for messages.
    ///
    /// Columns are separated by commas, semicolons or tabs, whichever the header has; with the last
    /// two a comma may be the decimal mark. Lines that begin with `#` are comments.
    ///
    /// # Errors
    /// As [`ForceCurve::read`].
    pub fn parse(bytes: &[u8], path: &Path) -> Result<Self, FitError> {
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        let text = std::str::from_utf8(bytes)
            .ok()
            .filter(|text| !text.contains('\0'))
            .ok_or_else(|| FitError::NotText { path: name(path) })?;
        let mut lines = (1..)
            .zip(text.lines())
            .map(|(number, line)| (number, line.trim()))
            .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let no_head = || FitError::NoHead { path: name(path) };
        let (line, head) = lines.next().ok_or_else(no_head)?;
        let separator = [';', '\t'].into_iter().find(|s| head.contains(*s));
        let separator = separator.unwrap_or(',');
        let names: Vec<&str> = head.split(separator).map(unquoted).collect();
        if names.iter().any(|name| number(name, separator).is_some()) {
            return Err(no_head());
        }
        let head = Head { path, line, names };
        let approach = head.column(APPROACH)?;
        let force = head.column(FORCE)?;
        let converged = head.names.iter().position(|name| *name == CONVERGED);

        let mut curve = ForceCurve::default();
        for (line, text) in lines {
            let cells: Vec<&str> = text.split(separator).map(unquoted).collect();
            if cells.len() != head.names.len() {
                return Err(FitError::Ragged {
                    path: name(path),
                    line,
                    found: cells.len(),
                    expected: head.names.len(),
                });
            }
            if converged.is_some_and(|at| cells[at] == "false") {
                curve.unconverged.push(line);
                continue;
            }
            let value = |column: &Column| column.value(path, line, &cells, separator);
            match (value(&approach)?, value(&force)?) {
                (Some(approach), Some(force)) => curve.samples.push(Sample { approach, force }),
                _ => curve.incomplete.push(line),
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
        extreme(APPROACH.0, |sample| sample.approach)?;
        extreme(FORCE.0, |sample| sample.force)?;
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
        constant(APPROACH.0, |a, b| a.approach == b.approach)?;
        constant(FORCE.0, |a, b| a.force == b.force)
    }
}

/// The name of a file in messages.
pub(super) fn name(path: &Path) -> String {
    path.display().to_string()
}

/// The header with the names of the columns.
struct Head<'a> {
    path: &'a Path,
    line: usize,
    names: Vec<&'a str>,
}

/// Index of a column and the factor to SI.
struct Column {
    name: &'static str,
    place: usize,
    factor: f64,
}

impl Head<'_> {
    fn column(
        &self,
        (column, dimension, example): (&'static str, Dimension, &'static str),
    ) -> Result<Column, FitError> {
        let mut found = None;
        for (place, text) in self.names.iter().enumerate() {
            let (word, unit) = name_and_unit(text);
            if !word.eq_ignore_ascii_case(column) {
                continue;
            }
            if found.is_some() {
                return Err(FitError::TwoColumns {
                    path: name(self.path),
                    line: self.line,
                    column,
                });
            }
            let factor = unit.map_or(Ok(1.0), |unit| unit_factor(unit, dimension));
            let factor = factor.map_err(|cause| FitError::Unit {
                path: name(self.path),
                line: self.line,
                column,
                cause,
            })?;
            found = Some(Column {
                name: column,
                place,
                factor,
            });
        }
        found.ok_or_else(|| FitError::NoColumn {
            path: name(self.path),
            line: self.line,
            column,
            example,
            found: quoted(&self.names.join(", ")),
        })
    }
}

impl Column {
    /// The value in SI; `None` where it is missing.
    fn value(
        &self,
        path: &Path,
        line: usize,
        cells: &[&str],
        separator: char,
    ) -> Result<Option<f64>, FitError> {
        let text = cells[self.place];
        let missing = ["", "nan", "na", "n/a"];
        if missing.iter().any(|word| text.eq_ignore_ascii_case(word)) {
            return Ok(None);
        }
        number(text, separator)
            .map(|value| value * self.factor)
            .filter(|value| value.is_finite())
            .map(Some)
            .ok_or_else(|| FitError::NotANumber {
                path: name(path),
                line,
                column: self.name,
                text: quoted(text),
            })
    }
}

/// `force [nN]` or `force (nN)` as name and unit.
fn name_and_unit(text: &str) -> (&str, Option<&str>) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, rest)) = text.split_once(open) {
            return (name.trim(), Some(rest.trim_end().trim_end_matches(close)));
        }
    }
    (text, None)
}

fn unquoted(cell: &str) -> &str {
    cell.trim().trim_matches('"').trim()
}

/// A number, with a decimal comma if commas do not separate.
fn number(text: &str, separator: char) -> Option<f64> {
    // `parse` accepts these words, but instruments do not mean them as numbers.
    let worded = |c: char| c.is_ascii_alphabetic() && !matches!(c, 'e' | 'E');
    if text.contains(worded) {
        return None;
    }
    if separator != ',' && text.matches(',').count() == 1 && !text.contains('.') {
        return text.replace(',', ".").parse().ok();
    }
    text.parse().ok()
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
        let curve = ForceCurve::parse(text.as_bytes(), Path::new("curve.csv")).unwrap();
        let pairs = curve.samples.iter().map(|s| (s.approach, s.force));
        pairs.take(curve.samples.len() - LEAST_ROWS).collect()
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
        let curve = ForceCurve::parse(text.as_bytes(), Path::new("curve.csv")).unwrap();
        assert_eq!(curve.incomplete, [2, 3]);
        assert_eq!(curve.unconverged, [4]);
        assert_eq!(curve.samples.len(), LEAST_ROWS);
    }
}
