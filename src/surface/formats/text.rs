//! Height maps as text: a matrix of numbers, one line a row.
//!
//! Numbers are separated by semicolons, tabs, blanks or commas; the separator is that of the whole
//! file. With the first three a comma may be the decimal mark. `#`, `%` and `//` begin comments, a
//! first line of words is a header, blank lines are skipped. Empty fields and `nan`, `na`, `n/a`
//! are missing pixels.

use std::borrow::Borrow;
use std::io::{BufRead, ErrorKind, Seek, SeekFrom};

use super::bytes::{Bytes, Opening};
use super::fields::{Marks, Separator, content, fields, is_words, number, split_comment};
use super::frame::Frame;
use super::lines::Lines;
use super::numbers::{NumberRows, Numbers};
use super::remarks::Remarks;
use super::xyz::{self, NoGrid, Points};
use crate::surface::MOST_POINTS;
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// Bytes that tell the rows of a text at a glance.
const BEGINNING: usize = 1 << 20;

/// Warns of heads whose units are not used.
pub(super) const UNITS_LEFT: &str = "its header gives units that are not used: give each column one in brackets, all the same, or x [um], y [um], z [nm] for points, \
     x [um], z [nm] for a profile; unit is that of the numbers";

/// What some programs begin a text in UTF-8 with.
const MARK: &[u8] = b"\xEF\xBB\xBF";

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
/// column from 1. All are found before the first row is given.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let opening = file.opening();
    let (text, mut matrix) = open(file)?;
    match xyz::as_grid(&text, &matrix, opening)? {
        Points::Grid(map) => return Ok(map),
        // A size in the comments is that of a matrix of heights.
        Points::Likely(warning) if matrix.size.is_none() => matrix.warnings.push(warning),
        Points::Likely(_) | Points::Unlikely => {}
    }
    let columns = matrix.columns;
    if text.remarks.leaves_units(columns, columns == 2) {
        matrix.warnings.push(UNITS_LEFT.to_owned());
    }
    matrix.warnings.extend(text.remarks.other_unit());
    if opening == Opening::Whole {
        return Ok(matrix.into());
    }
    let header = matrix.split().1;
    let rows = TextRows {
        lines: text.lines(),
        text,
        columns: header.columns,
        given: 0,
    };
    Ok(header.with(Numbers::Rows(Box::new(rows))))
}

/// A text of numbers and these, all checked, but kept only where one process reads the whole; at a glance about so many rows.
///
/// # Errors
/// As [`read`].
pub(super) fn open(file: Bytes) -> Result<(Text, Matrix), FileError> {
    let (opening, length) = (file.opening(), file.length());
    let file = match opening {
        Opening::Glance => beginning(file)?,
        _ => file,
    };
    let text = Text::new(&file)?;
    let mut matrix = text.matrix(opening == Opening::Whole)?;
    // Of a beginning as many more as the file is longer.
    matrix.rows = (matrix.rows as u128 * length as u128 / file.length() as u128) as usize;
    Ok((text, matrix))
}

/// The file up to the line in which its beginning ends.
fn beginning(file: Bytes) -> Result<Bytes, FileError> {
    let mut stream = file.stream();
    let sought = SeekFrom::Start(BEGINNING as u64);
    stream.seek(sought).map_err(FileError::Read)?;
    let mut length = BEGINNING;
    loop {
        let piece = stream.fill_buf().map_err(FileError::Read)?;
        let end = piece.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        if end.is_some() || piece.is_empty() {
            return Ok(file.shortened(length + end.map_or(0, |end| end + 1)));
        }
        let count = piece.len();
        length += count;
        stream.consume(count);
    }
}

/// A text of numbers. Each pass reads its lines again, so that they need no memory.
pub(super) struct Text {
    /// From the first line on.
    file: Bytes,
    line_end: u8,
    /// Number of the header line; 0 for none.
    header: usize,
    separator: Separator,
    margins: Margins,
    remarks: Remarks,
}

impl Text {
    /// How the numbers of a file are written, and the entries of its comments.
    fn new(file: &Bytes) -> Result<Self, FileError> {
        let mut file = file.clone();
        let start = file.beginning(MARK.len() + 2)?;
        let marked = start.strip_prefix(MARK);
        if marked.is_some() {
            file.skip(MARK.len(), "the file")?;
        }
        let start = marked.unwrap_or(&start);
        if start.starts_with(b"\xFF\xFE") || start.starts_with(b"\xFE\xFF") {
            return Err(FileError::Utf16);
        }
        let mut text = Text {
            line_end: line_end(&file)?,
            file,
            header: 0,
            separator: Separator::Blanks,
            margins: Margins::default(),
            remarks: Remarks::default(),
        };
        text.survey()?;
        text.margins = margins(&text)?;
        Ok(text)
    }

    /// Finds the separator, the header and what the comments say.
    fn survey(&mut self) -> Result<(), FileError> {
        let mut marks = Marks::default();
        let mut is_first = true;
        let mut lines = Lines::new(&self.file, self.line_end);
        while lines.advance()? {
            let line = lines.line();
            let comment = split_comment(line).1;
            self.remarks.take_comment(comment);
            if is_first {
                self.remarks.take_comment_above(comment);
            }
            let content = &line[content(line)];
            if content.trim().is_empty() {
                continue;
            }
            if is_first && is_words(content) {
                self.header = lines.number();
                self.remarks.take_heads(content);
            } else {
                marks.take(content);
            }
            is_first = false;
        }
        self.separator = marks.separator();
        if self.remarks.has_void_pixels {
            return Err(FileError::NotSupported {
                what: "texts of SPIP with void pixels",
                instead: "save it as .gsf or .gwy",
            });
        }
        Ok(())
    }

    /// The lines with content other than comments.
    fn lines(&self) -> NumberLines {
        NumberLines {
            lines: Lines::new(&self.file, self.line_end),
            header: self.header,
        }
    }

    /// Checks every number, and keeps them if so asked.
    fn matrix(&self, keeps: bool) -> Result<Matrix, FileError> {
        let (mut rows, mut columns) = (0_usize, 0);
        let mut values = Vec::new();
        let mut frame = Frame::default();
        let mut lines = self.lines();
        while let Some(line) = lines.next()? {
            rows += 1;
            let margins = self.margins.before + self.margins.after;
            // Another program may have changed the file since they were found.
            let found = fields(line.text, self.separator).count();
            let found = found.saturating_sub(margins);
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
            let points = rows.saturating_mul(columns);
            if points > MOST_POINTS {
                return Err(FileError::TooManyPoints {
                    points: points as u64,
                });
            }
            for (column, value) in (1..).zip(self.numbers(&line, rows, columns)) {
                let value = value?;
                frame.take(rows, column, value);
                if keeps {
                    values.push(value);
                }
            }
        }
        if rows * columns == 0 {
            return Err(FileError::NoNumbers);
        }
        Ok(Matrix {
            size: self.remarks.size().map(Size::Metres),
            // Of three columns that is not known before they form points.
            unit: self.remarks.number_unit(columns, columns == 2),
            lateral_unit: self
                .remarks
                .lateral_units(columns)
                .filter(|_| columns == 2 || rows == 2)
                .map(|[x, _]| x),
            places: self
                .remarks
                .named_profile()
                .filter(|_| columns == 2)
                .map(|[places, _]| places),
            frame: frame.warning(rows, columns),
            ..Matrix::new(values, [rows, columns])
        })
    }

    /// Hands on each row of three numbers with its place, from 1: those of `numbers` that are kept, or from the file again.
    ///
    /// # Errors
    /// What `take` says; the file cannot be read.
    pub(super) fn points(
        &self,
        numbers: &Matrix,
        take: &mut dyn FnMut(usize, [f64; 3]) -> Result<(), NoGrid>,
    ) -> Result<(), NoGrid> {
        let order = self.remarks.named_points(3).unwrap_or([0, 1, 2]);
        let mut take = |row: usize, point: [f64; 3]| take(row, order.map(|column| point[column]));
        let (kept, _) = numbers.values.as_chunks();
        for (row, point) in kept.iter().enumerate() {
            take(row + 1, *point)?;
        }
        if !kept.is_empty() {
            return Ok(());
        }
        let mut rows = TextRows {
            lines: self.lines(),
            text: self,
            columns: 3,
            given: 0,
        };
        let mut point = [0.0; 3];
        for row in 1..=numbers.rows {
            rows.next(&mut point)?;
            take(row, point)?;
        }
        Ok(())
    }

    /// What its comments and the heads of its columns say.
    pub(super) fn remarks(&self) -> &Remarks {
        &self.remarks
    }

    /// The numbers of a line, which is that of a row, at most so many.
    fn numbers<'a>(
        &self,
        line: &'a Line,
        row: usize,
        columns: usize,
    ) -> impl Iterator<Item = Result<f64, FileError>> + use<'a> {
        let separator = self.separator;
        let fields = fields(line.text, separator)
            .skip(self.margins.before)
            .take(columns);
        fields.enumerate().map(move |(column, field)| {
            number(field, separator).ok_or_else(|| FileError::NotANumber {
                line: line.number,
                row,
                column: column + 1,
                text: field.trim().chars().take(40).collect(),
            })
        })
    }
}

/// How the lines of a text end; it has no zero byte.
fn line_end(file: &Bytes) -> Result<u8, FileError> {
    let mut stream = file.rest();
    let mut end = b'\r';
    let mut offset = 0;
    loop {
        let piece = stream.fill_buf().map_err(FileError::Read)?;
        if piece.is_empty() {
            return Ok(end);
        }
        // Faster than to look for the place of a byte that is not there.
        if piece.contains(&0) {
            offset += piece.iter().take_while(|byte| **byte != 0).count();
            return Err(FileError::Binary { offset });
        }
        if piece.contains(&b'\n') {
            end = b'\n';
        }
        let count = piece.len();
        offset += count;
        stream.consume(count);
    }
}

/// The lines of a text that hold numbers.
struct NumberLines {
    lines: Lines,
    /// Number of the header line; 0 for none.
    header: usize,
}

impl NumberLines {
    fn next(&mut self) -> Result<Option<Line<'_>>, FileError> {
        while self.lines.advance()? {
            let (number, line) = (self.lines.number(), self.lines.line());
            let content = content(line);
            if number != self.header && !line[content.clone()].trim().is_empty() {
                let text = &self.lines.line()[content];
                return Ok(Some(Line { number, text }));
            }
        }
        Ok(None)
    }
}

/// Rows of a text whose numbers have been checked.
struct TextRows<T> {
    text: T,
    lines: NumberLines,
    columns: usize,
    /// Rows given so far.
    given: usize,
}

impl<T: Borrow<Text>> NumberRows for TextRows<T> {
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        // Another program may have cut the file since.
        let cut = || FileError::Read(ErrorKind::UnexpectedEof.into());
        for row in values.chunks_exact_mut(self.columns) {
            self.given += 1;
            let line = self.lines.next()?.ok_or_else(cut)?;
            let mut numbers = self.text.borrow().numbers(&line, self.given, self.columns);
            for value in row {
                *value = numbers.next().ok_or_else(cut)??;
            }
        }
        Ok(())
    }
}

/// Empty fields at the ends of every line: trailing separators, not missing pixels.
#[derive(Clone, Copy, Default)]
struct Margins {
    before: usize,
    after: usize,
}

/// Finds the separators that every line begins or ends with.
fn margins(text: &Text) -> Result<Margins, FileError> {
    let separator = text.separator;
    let empty = |field: Option<&str>| field.is_some_and(|field| field.trim().is_empty());
    let (mut before, mut after, mut fewest) = (true, true, usize::MAX);
    let mut lines = text.lines();
    while let Some(line) = lines.next()? {
        before &= empty(fields(line.text, separator).next());
        after &= empty(fields(line.text, separator).last());
        fewest = fewest.min(fields(line.text, separator).count());
        if !before && !after {
            break;
        }
    }
    // Every line keeps at least one field.
    let after = after && fewest > 1;
    Ok(Margins {
        before: usize::from(before && fewest > 1 + usize::from(after)),
        after: usize::from(after),
    })
}

#[cfg(test)]
#[path = "text_tests.rs"]
mod tests;
