//! Height maps as text: a matrix of numbers, one line a row.
//!
//! Numbers are separated by semicolons, tabs, blanks or commas; the separator is that of the whole
//! file. With the first three a comma may be the decimal mark. `#`, `%` and `//` begin comments, a
//! first line of words is a header, blank lines are skipped. Empty fields and `nan`, `na`, `n/a`
//! are missing pixels.

use super::bytes::Bytes;
use super::length::length_unit;
use super::xyz;
use crate::surface::MOST_POINTS;
use crate::surface::error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};
use crate::units::{Dimension, parse_quantity};

/// Separator of the numbers in a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    Semicolon,
    Comma,
    /// Single tabs, so that an empty field is a missing pixel.
    Tab,
    /// Any run of blanks and tabs.
    Blanks,
}

/// A line with numbers.
struct Line<'a> {
    /// Its number in the file, from 1.
    number: usize,
    /// Its text without comment, surrounding blanks and line end.
    text: &'a str,
}

/// Reads a matrix from the bytes of a text file, or a map from three columns x, y, z that form a
/// grid.
///
/// # Errors
/// Binary content, a field that is not a number, or rows of different length, with line, row and
/// column from 1.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let map = read_map(&file.all()?)?;
    file.expect_held([map.rows, map.columns])?;
    Ok(map.into())
}

fn read_map(bytes: &[u8]) -> Result<Matrix, FileError> {
    let (matrix, remarks) = read_columns(bytes)?;
    // A size in the comments means that this is a matrix of heights.
    if matrix.size.is_none()
        && let Some(map) = xyz::as_grid(&matrix, remarks.lateral_unit)
    {
        return Ok(map);
    }
    Ok(matrix)
}

/// Reads the numbers of a text file line by line, and the entries of its comments.
///
/// # Errors
/// As [`read`].
pub(super) fn read_columns(bytes: &[u8]) -> Result<(Matrix, Remarks), FileError> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    if bytes.starts_with(b"\xFF\xFE") || bytes.starts_with(b"\xFE\xFF") {
        return Err(FileError::Utf16);
    }
    if let Some(offset) = bytes.iter().position(|byte| *byte == 0) {
        return Err(FileError::Binary { offset });
    }
    // Comments may use another encoding (a Latin-1 micro sign); numbers cannot.
    let text = String::from_utf8_lossy(bytes);
    let body = Body::new(&text);
    let separator = separator(&body);
    let margins = margins(&body, separator);
    let count_fields =
        |line: &Line| fields(line.text, separator).count() - margins.before - margins.after;

    let (mut rows, mut columns) = (0, 0);
    let mut values = Vec::new();
    for line in body.lines() {
        rows += 1;
        let found = count_fields(&line);
        if rows == 1 {
            columns = found;
        }
        if found != columns {
            return Err(FileError::Ragged {
                line: line.number,
                row: rows,
                found,
                expected: columns,
            });
        }
        if values.len() + columns > MOST_POINTS {
            return Err(FileError::TooManyPoints {
                points: (values.len() + columns) as u64,
            });
        }
        let fields = fields(line.text, separator)
            .skip(margins.before)
            .take(columns);
        for (column, field) in fields.enumerate() {
            let value = number(field, separator).ok_or_else(|| FileError::NotANumber {
                line: line.number,
                row: rows,
                column: column + 1,
                text: field.trim().chars().take(40).collect(),
            })?;
            values.push(value);
        }
    }
    if values.is_empty() {
        return Err(FileError::NoNumbers);
    }
    let remarks = Remarks::from_body(&body);
    let size = remarks.width.zip(remarks.height);
    let matrix = Matrix {
        size: size.map(|(x, y)| Size::Metres([x, y])),
        unit: remarks.unit,
        ..Matrix::new(values, [rows, columns])
    };
    Ok((matrix, remarks))
}

/// The text of a file, line by line. Each pass finds the lines again, so that they need no memory.
struct Body<'a> {
    text: &'a str,
    line_end: char,
    /// Number of the header line; 0 for none.
    header: usize,
}

impl<'a> Body<'a> {
    fn new(text: &'a str) -> Self {
        let mut body = Body {
            text,
            line_end: if text.contains('\n') { '\n' } else { '\r' },
            header: 0,
        };
        let first = body.lines().next();
        if let Some(line) = first.filter(|line| is_words(line.text)) {
            body.header = line.number;
        }
        body
    }

    /// The lines with content other than comments.
    fn lines(&self) -> impl Iterator<Item = Line<'a>> {
        let header = self.header;
        let lines = self.text.split(self.line_end).enumerate();
        lines.filter_map(move |(index, line)| {
            let number = index + 1;
            // Tabs stay: they may separate missing numbers.
            let text = split_comment(line).0.trim_matches([' ', '\r', '\u{c}']);
            let holds_numbers = number != header && !text.trim().is_empty();
            holds_numbers.then_some(Line { number, text })
        })
    }
}

/// A line's content and its comment.
fn split_comment(line: &str) -> (&str, &str) {
    let start = [line.find('#'), line.find('%'), line.find("//")];
    match start.into_iter().flatten().min() {
        Some(start) => line.split_at(start),
        None => (line, ""),
    }
}

/// Whether a line consists of words, none of them a number.
fn is_words(line: &str) -> bool {
    line.split([' ', '\t', ',', ';'])
        .filter(|word| !word.is_empty())
        .all(|word| number(word, Separator::Blanks).is_none())
}

/// The separator of the file: the first of semicolon, comma, tab, blanks that it uses.
fn separator(body: &Body) -> Separator {
    let (mut semicolons, mut commas, mut tabs, mut blanks) = (false, false, false, false);
    let (mut several, mut decimal_commas) = (false, true);
    for line in body.lines() {
        let comma = line.text.contains(',');
        semicolons |= line.text.contains(';');
        commas |= comma;
        tabs |= line.text.contains('\t');
        blanks |= line.text.contains(' ');
        several |= line.text.split_whitespace().nth(1).is_some();
        decimal_commas &= !comma || line.text.split_whitespace().all(has_decimal_comma);
    }
    if semicolons {
        Separator::Semicolon
    } else if commas && !(several && decimal_commas) {
        // A single `1,5` on each line is taken as two numbers.
        Separator::Comma
    } else if tabs && !blanks {
        Separator::Tab
    } else {
        Separator::Blanks
    }
}

/// Whether a word has no comma, or exactly one, between digits, as a decimal mark.
fn has_decimal_comma(word: &str) -> bool {
    word.split_once(',').is_none_or(|(whole, fraction)| {
        whole.ends_with(|c: char| c.is_ascii_digit())
            && fraction.starts_with(|c: char| c.is_ascii_digit())
            && !fraction.contains([',', '.'])
            && !whole.contains('.')
    })
}

/// The fields of a line.
fn fields(text: &str, separator: Separator) -> Box<dyn Iterator<Item = &str> + '_> {
    match separator {
        Separator::Semicolon => Box::new(text.split(';')),
        Separator::Comma => Box::new(text.split(',')),
        Separator::Tab => Box::new(text.split('\t')),
        Separator::Blanks => Box::new(text.split_ascii_whitespace()),
    }
}

/// Empty fields at the ends of every line: trailing separators, not missing pixels.
struct Margins {
    before: usize,
    after: usize,
}

/// Finds the separators that every line begins or ends with.
fn margins(body: &Body, separator: Separator) -> Margins {
    let empty = |field: Option<&str>| field.is_some_and(|field| field.trim().is_empty());
    let (mut before, mut after, mut fewest) = (true, true, usize::MAX);
    for line in body.lines() {
        before &= empty(fields(line.text, separator).next());
        after &= empty(fields(line.text, separator).last());
        fewest = fewest.min(fields(line.text, separator).count());
        if !before && !after {
            break;
        }
    }
    // Every line keeps at least one field.
    let after = after && fewest > 1;
    Margins {
        before: usize::from(before && fewest > 1 + usize::from(after)),
        after: usize::from(after),
    }
}

/// The number in a field; NaN if it is missing, `None` if it is not a number.
fn number(field: &str, separator: Separator) -> Option<f64> {
    let field = field.trim();
    let field = field
        .strip_prefix('"')
        .and_then(|field| field.strip_suffix('"'))
        .unwrap_or(field)
        .trim();
    if let Ok(value) = field.parse() {
        return Some(value);
    }
    if field.is_empty()
        || ["na", "n/a"]
            .iter()
            .any(|mark| field.eq_ignore_ascii_case(mark))
    {
        return Some(f64::NAN);
    }
    // A decimal comma, where commas do not separate; Fortran's exponent mark.
    let mut other: String = field
        .chars()
        .map(|c| if matches!(c, 'd' | 'D') { 'e' } else { c })
        .collect();
    if separator != Separator::Comma && !other.contains('.') {
        other = other.replacen(',', ".", 1);
    }
    other.parse().ok()
}

/// Name and value of a comment.
fn entry(comment: &str) -> Option<(&str, &str)> {
    comment
        .trim_start_matches(['#', '%', '/', ' '])
        .split_once(':')
}

/// Lengths stated in the comments, in the form of Gwyddion's text export.
#[derive(Clone, Copy, Default)]
pub(super) struct Remarks {
    width: Option<f64>,
    height: Option<f64>,
    unit: Option<f64>,
    /// Metres per unit of x and y of points with coordinates.
    pub(super) lateral_unit: Option<f64>,
}

impl Remarks {
    /// All comments of a file.
    fn from_body(body: &Body) -> Self {
        let mut remarks = Remarks::default();
        // The values of the last three comments of the form `name: value`.
        let mut last = [""; 3];
        for line in body.text.split(body.line_end) {
            let Some((name, value)) = entry(split_comment(line).1) else {
                continue;
            };
            remarks.take(name, value);
            last = [last[1], last[2], value];
            remarks.take_by_order(last);
        }
        remarks
    }

    /// Gwyddion writes width, height and unit in this order, with names in the language of its user.
    fn take_by_order(&mut self, [width, height, unit]: [&str; 3]) {
        if let (None, None, Some(width), Some(height)) =
            (self.width, self.height, length(width), length(height))
            && let Some(unit) = length_unit(unit)
        {
            *self = Remarks {
                width: Some(width),
                height: Some(height),
                unit: Some(unit),
                ..*self
            };
        }
    }

    /// Reads `# Width: 5.0 um`, `# Height: 5.0 um`, `# Value units: m`, `# Lateral units: um`.
    fn take(&mut self, name: &str, value: &str) {
        match name.trim().to_ascii_lowercase().as_str() {
            "width" => self.width = length(value),
            "height" => self.height = length(value),
            "value units" => self.unit = length_unit(value),
            "lateral units" => self.lateral_unit = length_unit(value),
            _ => {}
        }
    }
}

/// A positive length with its unit, m.
fn length(text: &str) -> Option<f64> {
    let text = text
        .trim()
        .replacen(',', ".", usize::from(!text.contains('.')));
    let text = text.as_str();
    // For supported units this is the double nearest to the digits.
    if let Ok(length) = parse_quantity(text, Dimension::Length) {
        return (length > 0.0).then_some(length);
    }
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE ".contains(c)))?;
    let (number, name) = text.split_at(end);
    let value: f64 = number.trim().parse().ok()?;
    let metres = value * length_unit(name)?;
    (metres.is_finite() && metres > 0.0).then_some(metres)
}

#[cfg(test)]
#[path = "text_tests.rs"]
mod tests;
