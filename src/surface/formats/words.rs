//! Numbers of a text whose header says how many there are: one word each, whatever the lines.

use super::bytes::{Bytes, Opening};
use super::lines::Lines;
use super::numbers::{NumberRows, Numbers};
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix};

/// The words of a text, one after another.
pub(super) struct Words {
    lines: Lines,
    /// Bytes of the line that have been read.
    read: usize,
    /// Number of the line of the last word.
    line: usize,
}

impl Words {
    /// The words from the next line on.
    pub fn new(lines: Lines) -> Self {
        Words {
            read: lines.line().len(),
            line: lines.number().max(1),
            lines,
        }
    }

    /// The next word and the number of its line; `None` at the end.
    pub fn next(&mut self) -> Result<Option<(usize, &str)>, FileError> {
        loop {
            let rest = &self.lines.line().as_bytes()[self.read..];
            let start = rest.iter().position(|byte| !byte.is_ascii_whitespace());
            if let Some(start) = start {
                let word = &rest[start..];
                let length = word.iter().position(u8::is_ascii_whitespace);
                let start = self.read + start;
                self.read = start + length.unwrap_or(word.len());
                self.line = self.lines.number();
                return Ok(Some((self.line, &self.lines.line()[start..self.read])));
            }
            self.read = 0;
            if !self.lines.advance()? {
                return Ok(None);
            }
        }
    }

    /// Number of the line of the last word, from 1.
    pub fn line(&self) -> usize {
        self.line
    }

    /// Number of the last line that has been read.
    pub fn last_line(&self) -> usize {
        self.lines.number()
    }
}

/// Reads the number of a map of which so many stand before it, and that has such a shape.
type Number = fn(&mut Words, usize, [usize; 2]) -> Result<f64, FileError>;

/// The numbers of a map, row after row.
pub(super) struct WordRows {
    words: Words,
    shape: [usize; 2],
    number: Number,
    /// Numbers given so far.
    given: usize,
}

impl WordRows {
    /// Numbers of a map of a shape, from the next word on.
    pub fn new(words: Words, shape: [usize; 2], number: Number) -> Self {
        WordRows {
            words,
            shape,
            number,
            given: 0,
        }
    }

    fn number(&mut self) -> Result<f64, FileError> {
        let number = (self.number)(&mut self.words, self.given, self.shape)?;
        self.given += 1;
        Ok(number)
    }
}

impl NumberRows for WordRows {
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        for value in values {
            *value = self.number()?;
        }
        Ok(())
    }
}

/// The map that `open` finds in a file. Before its rows go to several processes all are read once, so that a wrong number is
/// found wherever it is.
pub(super) fn checked(
    file: &Bytes,
    open: fn(&Bytes) -> Result<Matrix<WordRows>, FileError>,
) -> Result<Map, FileError> {
    let (mut rows, mut header) = open(file)?.split();
    if file.opening() == Opening::ByRows {
        for _ in 0..header.rows * header.columns {
            rows.number()?;
        }
        (rows, header) = open(file)?.split();
    }
    Ok(header.with(Numbers::Rows(Box::new(rows))))
}

#[cfg(test)]
mod tests {
    use super::super::{sdf, surfer};
    use super::*;
    use std::io::Cursor;

    type Reader = fn(Bytes) -> Result<Map, FileError>;

    const GRD: &str = "DSAA\r\n3 2\r\n0 2 0 1\r\n\r\n1 6\r\n1 2\r\n3\r\n4 5 1.8e38 rest\r\n";
    const SDF: &str = "aISO-1.0\nManufID = x\nNumPoints = 3\nNumProfiles = 2\nXscale = 1\nYscale = 1\nnumpoints = 7\nZscale = 2\n*\n1 2\n\n3 4 bad 6\n* 7\n*\n";

    fn open(read: Reader, text: &str, opening: Opening) -> Result<Map, FileError> {
        let bytes = text.as_bytes().to_vec();
        let length = bytes.len();
        read(Bytes::new(Cursor::new(bytes), length, opening))
    }

    /// One number after another, on whichever lines, and nothing after the last.
    #[test]
    fn words_stand_on_any_lines() {
        let nan = f64::NAN;
        for (read, text, numbers) in [
            (surfer::read as Reader, GRD, [1.0, 2.0, 3.0, 4.0, 5.0, nan]),
            (sdf::read, SDF, [1.0, 2.0, 3.0, 4.0, nan, 6.0]),
        ] {
            for opening in [Opening::Whole, Opening::ByRows, Opening::Glance] {
                let map = open(read, text, opening).unwrap();
                assert_eq!([map.columns, map.rows], [3, 2]);
                let values = map.read().unwrap().values;
                let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(&values), bits(&numbers));
            }
        }
    }

    /// What is wrong is found before rows are handed on, in the same words; a glance sees the header alone.
    #[test]
    fn wrong_numbers_are_found_first() {
        let grd = |from: &str, to: &str| GRD.replace(from, to);
        let sdf = |from: &str, to: &str| SDF.replace(from, to);
        for (read, text, words) in [
            (
                surfer::read as Reader,
                grd("5 1.8e38", "5 x\u{b5}"),
                "line 8: \"x\u{c2}\u{b5}\" is not a number; the height of row 2, column 3 is expected",
            ),
            (
                surfer::read,
                grd("5 1.8e38 rest", "5\r\n\r\n"),
                "line 8: the file ends before the height of row 2, column 3",
            ),
            (
                sdf::read,
                sdf("bad 6", "bad x"),
                "line 12 (row 2), column 3: \"x\" is not a number",
            ),
            (
                sdf::read,
                sdf("bad 6", ""),
                "line 13: the heights end after 4 of 6, in row 2",
            ),
            (
                sdf::read,
                sdf("bad 6\n* 7\n*", "5\n\n"),
                "line 14: the heights end after 5 of 6, in row 2",
            ),
        ] {
            let whole = open(read, &text, Opening::Whole)
                .and_then(Map::read)
                .unwrap_err();
            assert!(whole.to_string().contains(words), "{whole}");
            let by_rows = open(read, &text, Opening::ByRows)
                .map(|map| map.split().1)
                .unwrap_err();
            assert_eq!(by_rows.to_string(), whole.to_string());
            assert!(open(read, &text, Opening::Glance).is_ok());
        }
    }
}
