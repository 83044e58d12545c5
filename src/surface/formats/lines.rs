//! The lines of a text, one after another, of which one is held.

use std::io::{BufRead, BufReader, Read};

use super::bytes::{Bytes, Stream, latin_1};
use crate::surface::file_error::FileError;

/// The lines from a place of a file on.
pub(super) struct Lines {
    stream: BufReader<Stream>,
    /// Bytes of the longest line that is held.
    longest: u64,
    end: u8,
    decode: fn(Vec<u8>) -> String,
    number: usize,
    line: String,
}

impl Lines {
    /// The unread lines of a file, each of which ends with `end`. Comments may use another encoding than UTF-8 (a Latin-1
    /// micro sign); numbers cannot.
    pub fn new(file: &Bytes, end: u8) -> Self {
        Lines::decoded(file, end, |bytes| {
            String::from_utf8(bytes)
                .unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned())
        })
    }

    /// The unread lines of a file in Latin-1.
    pub fn latin_1(file: &Bytes) -> Self {
        Lines::decoded(file, b'\n', |bytes| match bytes.is_ascii() {
            true => String::from_utf8(bytes).unwrap_or_default(),
            false => latin_1(&bytes),
        })
    }

    fn decoded(file: &Bytes, end: u8, decode: fn(Vec<u8>) -> String) -> Self {
        Lines {
            stream: file.rest(),
            longest: file.longest_line(),
            end,
            decode,
            number: 0,
            line: String::new(),
        }
    }

    /// Goes on to the next line; whether there is one.
    ///
    /// # Errors
    /// The file cannot be read, or the line has more bytes than may be held.
    pub fn advance(&mut self) -> Result<bool, FileError> {
        let mut bytes = std::mem::take(&mut self.line).into_bytes();
        bytes.clear();
        let mut stream = self.stream.by_ref().take(self.longest.saturating_add(1));
        let count = stream.read_until(self.end, &mut bytes);
        let count = count.map_err(FileError::Read)? as u64;
        if count > self.longest {
            return Err(FileError::LongLine {
                line: self.number + 1,
                longest: self.longest,
            });
        }
        if bytes.last() == Some(&self.end) {
            bytes.pop();
        }
        self.line = (self.decode)(bytes);
        self.number += usize::from(count > 0);
        Ok(count > 0)
    }

    /// Number of the line, from 1; 0 before the first.
    pub fn number(&self) -> usize {
        self.number
    }

    /// The line without its end.
    pub fn line(&self) -> &str {
        &self.line
    }
}

/// A mistake in a line of a text of a format, such as `.sdf`.
pub(super) fn broken_line(format: &'static str, line: usize, what: impl Into<String>) -> FileError {
    FileError::BrokenText {
        format,
        line,
        what: what.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &[u8], longest: u64) -> Lines {
        let mut lines = Lines::new(&Bytes::held(text.to_vec()), b'\n');
        lines.longest = longest;
        lines
    }

    #[test]
    fn lines_have_numbers_and_a_longest_length() {
        let mut found = lines(b"ab\n\n\xB5c", 3);
        for (number, line) in [(1, "ab"), (2, ""), (3, "\u{fffd}c")] {
            assert!(found.advance().unwrap());
            assert_eq!((found.number(), found.line()), (number, line));
        }
        assert!(!found.advance().unwrap());
        let mut found = lines(b"ab\nabcd\n", 3);
        assert!(found.advance().unwrap());
        let error = found.advance().unwrap_err();
        assert!(
            matches!(
                error,
                FileError::LongLine {
                    line: 2,
                    longest: 3
                }
            ),
            "{error}"
        );
    }
}
