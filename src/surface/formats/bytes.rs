//! Reads a binary file number by number, without holding it; every error has its offset.

use std::cell::RefCell;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::rc::Rc;

use super::numbers::{Numbers, RawRows};
use crate::surface::MOST_POINTS;
use crate::surface::file_error::FileError;

/// What a file is read from.
pub(super) trait Source: Read + Seek {}

impl<S: Read + Seek> Source for S {}

/// What a map is opened for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::surface) enum Opening {
    /// To be read by one process, which may hold all of it.
    Whole,
    /// To be read some rows at a time, of which alone are held.
    ByRows,
    /// To see of how many points it is: none is read, and of a text the beginning tells.
    Glance,
}

/// Bytes of the longest line of a text of which several processes read some rows at a time, 512 MiB: more numbers than a grid
/// has points along x.
const LONGEST_LINE: u64 = 1 << 29;

/// Bytes in which the end of a text is looked for.
const PIECE: usize = 256;

/// Bytes of a text that are read at once.
const STREAMED: usize = 1 << 16;

/// The bytes of one file of a named format and the read position. A clone reads the same file from a position of its own.
#[derive(Clone)]
pub(super) struct Bytes {
    /// Name of the format in messages, such as `.sur`.
    format: &'static str,
    source: Rc<RefCell<dyn Source>>,
    length: usize,
    at: usize,
    opening: Opening,
}

/// Reads a number of fixed width.
macro_rules! numbers {
    ($order:literal, $from:ident: $($name:ident: $kind:ty),*) => {
        $(
            #[doc = concat!("The next ", $order, "-endian `", stringify!($kind), "`; `what` names it in messages.")]
            pub(super) fn $name(&mut self, what: &str) -> Result<$kind, FileError> {
                self.array(what).map(<$kind>::$from)
            }
        )*
    };
}

impl Bytes {
    /// The first `length` bytes of a file.
    pub(super) fn new(source: impl Source + 'static, length: usize, opening: Opening) -> Self {
        Bytes {
            format: "",
            source: Rc::new(RefCell::new(source)),
            length,
            at: 0,
            opening,
        }
    }

    /// Bytes in memory.
    #[cfg(test)]
    pub(super) fn held(bytes: Vec<u8>) -> Self {
        let length = bytes.len();
        Bytes::new(std::io::Cursor::new(bytes), length, Opening::Whole)
    }

    /// The same bytes as those of a format, by its name in messages.
    pub(super) fn named(self, format: &'static str) -> Self {
        Bytes { format, ..self }
    }

    numbers!("little", from_le_bytes: u8: u8, u16: u16, i16: i16, u32: u32, i32: i32, f32: f32, f64: f64);
    numbers!("big", from_be_bytes: big_u16: u16, big_i16: i16, big_u32: u32, big_f32: f32);

    /// The next doubles; `what` names them in messages.
    pub(super) fn doubles<const COUNT: usize>(
        &mut self,
        what: &str,
    ) -> Result<[f64; COUNT], FileError> {
        let mut numbers = [0.0; COUNT];
        for number in &mut numbers {
            *number = self.f64(what)?;
        }
        Ok(numbers)
    }

    /// Offset of the next byte, from 0.
    pub(super) fn offset(&self) -> usize {
        self.at
    }

    /// What it is opened for.
    pub(super) fn opening(&self) -> Opening {
        self.opening
    }

    /// The first bytes of the file, of at most `length`.
    pub(super) fn shortened(self, length: usize) -> Self {
        let length = self.length.min(length);
        Bytes { length, ..self }
    }

    /// The file as a stream.
    pub(super) fn stream(&self) -> BufReader<Stream> {
        BufReader::new(Stream(Bytes {
            at: 0,
            ..self.clone()
        }))
    }

    /// The unread bytes as a stream that is read to its end.
    pub(super) fn rest(&self) -> BufReader<Stream> {
        BufReader::with_capacity(STREAMED, Stream(self.clone()))
    }

    /// Length of the file.
    pub(super) fn length(&self) -> usize {
        self.length
    }

    /// Number of unread bytes.
    pub(super) fn left(&self) -> usize {
        self.length - self.at
    }

    /// A mistake at `offset`.
    pub(super) fn broken(&self, offset: usize, what: impl Into<String>) -> FileError {
        FileError::Broken {
            format: self.format,
            offset,
            what: what.into(),
        }
    }

    /// Reads the next bytes, as many as the list has; they must be there.
    pub(super) fn fill(&mut self, bytes: &mut [u8]) -> Result<(), FileError> {
        let mut source = self.source.borrow_mut();
        let start = SeekFrom::Start(self.at as u64);
        // A seek empties the buffer of a file.
        if source.stream_position().map_err(FileError::Read)? != self.at as u64 {
            source.seek(start).map_err(FileError::Read)?;
        }
        source.read_exact(bytes).map_err(FileError::Read)?;
        self.at += bytes.len();
        Ok(())
    }

    /// Passes over the next `count` bytes.
    pub(super) fn skip(&mut self, count: usize, what: &str) -> Result<(), FileError> {
        if count > self.left() {
            return Err(self.ends_within(what));
        }
        self.at += count;
        Ok(())
    }

    fn ends_within(&self, what: &str) -> FileError {
        self.broken(
            self.length,
            format!(
                "the file ends within {what}, which begins at byte {}",
                self.at
            ),
        )
    }

    /// The next `count` bytes.
    pub(super) fn take(&mut self, count: usize, what: &str) -> Result<Vec<u8>, FileError> {
        if count > self.left() {
            return Err(self.ends_within(what));
        }
        let mut bytes = zeros(count)?;
        self.fill(&mut bytes)?;
        Ok(bytes)
    }

    /// The first bytes of the file, at most `count`.
    pub(super) fn beginning(&self, count: usize) -> Result<Vec<u8>, FileError> {
        let mut file = Bytes {
            at: 0,
            ..self.clone()
        };
        file.take(count.min(self.length), "the file")
    }

    /// Bytes of the longest line of a text, of which one is held.
    pub(super) fn longest_line(&self) -> u64 {
        match self.opening {
            Opening::Whole => u64::MAX,
            Opening::ByRows | Opening::Glance => LONGEST_LINE,
        }
    }

    /// The next bytes as an array.
    fn array<const COUNT: usize>(&mut self, what: &str) -> Result<[u8; COUNT], FileError> {
        let mut array = [0; COUNT];
        if COUNT > self.left() {
            return Err(self.ends_within(what));
        }
        self.fill(&mut array)?;
        Ok(array)
    }

    /// Number of bytes up to the next zero byte, without it.
    pub(super) fn until_zero(&self, what: &str) -> Result<usize, FileError> {
        let mut ahead = self.clone();
        while ahead.left() > 0 {
            let start = ahead.at;
            let piece = ahead.take(PIECE.min(ahead.left()), what)?;
            if let Some(place) = piece.iter().position(|byte| *byte == 0) {
                return Ok(start - self.at + place);
            }
        }
        Err(self.ends_within(what))
    }

    /// A text in a field of `count` bytes, up to its first zero byte: UTF-8, else Latin-1.
    pub(super) fn text(&mut self, count: usize, what: &str) -> Result<String, FileError> {
        let field = self.take(count, what)?;
        let text = field.split(|byte| *byte == 0).next().unwrap_or(&field);
        let text = match std::str::from_utf8(text) {
            Ok(text) => text.to_owned(),
            Err(_) => latin_1(text),
        };
        Ok(text.trim().to_owned())
    }

    /// Moves to `offset`, which must lie within the file.
    pub(super) fn seek(&mut self, offset: usize, what: &str) -> Result<(), FileError> {
        if offset > self.length {
            return Err(self.broken(
                self.at,
                format!(
                    "{what} is said to begin at byte {offset}, but the file has {}",
                    self.length
                ),
            ));
        }
        self.at = offset;
        Ok(())
    }

    /// The numbers of a matrix; a row takes `stride` bytes and begins with its elements.
    ///
    /// # Errors
    /// Too few bytes for the shape.
    pub(super) fn matrix<const SIZE: usize>(
        &mut self,
        [rows, columns]: [usize; 2],
        stride: usize,
        number: impl Fn([u8; SIZE]) -> f64 + 'static,
    ) -> Result<RawRows, FileError> {
        let row_bytes = columns * SIZE;
        let expected = (rows as u64).saturating_mul(stride as u64);
        // The padding after the last row is not needed.
        let needed = expected - (stride - row_bytes) as u64;
        if (self.left() as u64) < needed {
            return Err(FileError::Truncated {
                rows,
                columns,
                expected: needed,
                found: self.left() as u64,
            });
        }
        let numbers = RawRows::new(self.clone(), [rows, columns], [SIZE, stride], number);
        self.at += self.left().min(expected as usize);
        Ok(numbers)
    }

    /// The numbers of a matrix without padding.
    pub(super) fn packed<const SIZE: usize>(
        &mut self,
        shape: [usize; 2],
        number: impl Fn([u8; SIZE]) -> f64 + 'static,
    ) -> Result<Numbers, FileError> {
        Ok(self.matrix(shape, SIZE * shape[1], number)?.into())
    }

    /// The numbers of a matrix of which columns lie one after another.
    pub(super) fn by_columns<const SIZE: usize>(
        &mut self,
        [rows, columns]: [usize; 2],
        number: impl Fn([u8; SIZE]) -> f64 + 'static,
    ) -> Result<Numbers, FileError> {
        let lines = self.matrix([columns, rows], SIZE * rows, number)?;
        Ok(lines.transposed().into())
    }

    /// Warns of trailing bytes that are not read.
    pub(super) fn warn_of_rest(&self, warnings: &mut Vec<String>) {
        if self.left() > 0 {
            warnings.push(format!(
                "the file holds {} bytes after its heights, which are not read",
                self.left()
            ));
        }
    }
}

/// The bytes of a file from its beginning, for programs that read one by themselves.
pub(super) struct Stream(Bytes);

impl Read for Stream {
    fn read(&mut self, bytes: &mut [u8]) -> std::io::Result<usize> {
        let count = bytes.len().min(self.0.left());
        let done = self.0.fill(&mut bytes[..count]);
        done.map(|()| count).map_err(|error| match error {
            FileError::Read(error) => error,
            other => std::io::Error::other(other),
        })
    }
}

impl Seek for Stream {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        let place = match to {
            SeekFrom::Start(place) => i128::from(place),
            SeekFrom::Current(by) => self.0.at as i128 + i128::from(by),
            SeekFrom::End(by) => self.0.length as i128 + i128::from(by),
        };
        if place < 0 {
            return Err(std::io::ErrorKind::InvalidInput.into());
        }
        // Beyond the end there is nothing to read.
        let length = self.0.length;
        self.0.at = usize::try_from(place).map_or(length, |place| place.min(length));
        Ok(self.0.at as u64)
    }
}

/// Rows and columns from a file, checked against the limits of a grid.
///
/// # Errors
/// Zero or negative numbers, and more points than a grid may have, without overflow.
pub(super) fn checked_shape(rows: i64, columns: i64) -> Result<[usize; 2], FileError> {
    let counts = [rows, columns].map(|count| usize::try_from(count).ok().filter(|n| *n > 0));
    let [Some(rows), Some(columns)] = counts else {
        return Err(FileError::Counts { rows, columns });
    };
    match rows.checked_mul(columns) {
        Some(points) if points <= MOST_POINTS => Ok([rows, columns]),
        product => Err(FileError::TooManyPoints {
            points: product.map_or(u64::MAX, |points| points as u64),
        }),
    }
}

/// Refuses a text of `length` bytes with fewer numbers than a shape has.
pub(super) fn refuse_short_text(
    [rows, columns]: [usize; 2],
    length: usize,
) -> Result<(), FileError> {
    // Each number takes at least a digit and a blank.
    if rows * columns <= length / 2 + 1 {
        return Ok(());
    }
    Err(FileError::Truncated {
        rows,
        columns,
        expected: 2 * (rows * columns) as u64 - 1,
        found: length as u64,
    })
}

/// Decodes Latin-1.
pub(super) fn latin_1(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| char::from(*byte)).collect()
}

/// So many bytes, all 0; an error where there is no memory for them.
pub(super) fn zeros(count: usize) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    bytes
        .try_reserve_exact(count)
        .map_err(|_| FileError::Memory {
            bytes: count as u64,
        })?;
    bytes.resize(count, 0);
    Ok(bytes)
}

/// An empty list with capacity for all points of a shape, if memory allows.
pub(super) fn with_capacity([rows, columns]: [usize; 2]) -> Result<Vec<f64>, FileError> {
    let mut values = Vec::new();
    values
        .try_reserve_exact(rows * columns)
        .map_err(|_| FileError::Memory {
            bytes: (rows * columns * size_of::<f64>()) as u64,
        })?;
    Ok(values)
}
