//! Reads the bytes of a binary file number by number; every error has its offset.

use crate::surface::MOST_POINTS;
use crate::surface::error::FileError;

/// The bytes of one file of a named format and the read position.
pub(super) struct Bytes<'a> {
    /// Name of the format in messages, such as `.sur`.
    format: &'static str,
    bytes: &'a [u8],
    at: usize,
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

impl<'a> Bytes<'a> {
    pub(super) fn new(format: &'static str, bytes: &'a [u8]) -> Self {
        Bytes {
            format,
            bytes,
            at: 0,
        }
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

    /// Number of unread bytes.
    pub(super) fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// A mistake at `offset`.
    pub(super) fn broken(&self, offset: usize, what: impl Into<String>) -> FileError {
        FileError::Broken {
            format: self.format,
            offset,
            what: what.into(),
        }
    }

    /// The next `count` bytes.
    pub(super) fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8], FileError> {
        match self.bytes[self.at..].split_at_checked(count) {
            Some((taken, _)) => {
                self.at += count;
                Ok(taken)
            }
            None => Err(self.broken(
                self.bytes.len(),
                format!(
                    "the file ends within {what}, which begins at byte {}",
                    self.at
                ),
            )),
        }
    }

    /// The next bytes as an array.
    fn array<const COUNT: usize>(&mut self, what: &str) -> Result<[u8; COUNT], FileError> {
        let mut array = [0; COUNT];
        array.copy_from_slice(self.take(COUNT, what)?);
        Ok(array)
    }

    /// Bytes up to the next zero byte, without it.
    pub(super) fn until_zero(&self, what: &str) -> Result<usize, FileError> {
        let rest = &self.bytes[self.at..];
        rest.iter().position(|byte| *byte == 0).ok_or_else(|| {
            self.broken(
                self.bytes.len(),
                format!(
                    "the file ends within {what}, which begins at byte {}",
                    self.at
                ),
            )
        })
    }

    /// A text in a field of `count` bytes, up to its first zero byte: UTF-8, else Latin-1.
    pub(super) fn text(&mut self, count: usize, what: &str) -> Result<String, FileError> {
        let field = self.take(count, what)?;
        let text = field.split(|byte| *byte == 0).next().unwrap_or(field);
        let text = match std::str::from_utf8(text) {
            Ok(text) => text.to_owned(),
            Err(_) => latin_1(text),
        };
        Ok(text.trim().to_owned())
    }

    /// Moves to `offset`, which must lie within the file.
    pub(super) fn seek(&mut self, offset: usize, what: &str) -> Result<(), FileError> {
        if offset > self.bytes.len() {
            return Err(self.broken(
                self.at,
                format!(
                    "{what} is said to begin at byte {offset}, but the file has {}",
                    self.bytes.len()
                ),
            ));
        }
        self.at = offset;
        Ok(())
    }

    /// The numbers of a matrix; a row takes `stride` bytes and begins with its elements.
    ///
    /// # Errors
    /// Too few bytes for the shape, and too little memory.
    pub(super) fn matrix<const SIZE: usize>(
        &mut self,
        [rows, columns]: [usize; 2],
        stride: usize,
        number: impl Fn([u8; SIZE]) -> f64,
    ) -> Result<Vec<f64>, FileError> {
        let row_bytes = columns * SIZE;
        let expected = (rows as u64).saturating_mul(stride as u64);
        // The padding after the last row is not needed.
        let needed = expected - (stride - row_bytes) as u64;
        let elements = &self.bytes[self.at..];
        if (elements.len() as u64) < needed {
            return Err(FileError::Truncated {
                rows,
                columns,
                expected: needed,
                found: elements.len() as u64,
            });
        }
        let mut values = with_capacity([rows, columns])?;
        for row in elements.chunks(stride).take(rows) {
            values.extend(row[..row_bytes].chunks_exact(SIZE).map(|element| {
                let mut bytes = [0; SIZE];
                bytes.copy_from_slice(element);
                number(bytes)
            }));
        }
        self.at += elements.len().min(expected as usize);
        Ok(values)
    }

    /// The numbers of a matrix without padding.
    pub(super) fn packed<const SIZE: usize>(
        &mut self,
        shape: [usize; 2],
        number: impl Fn([u8; SIZE]) -> f64,
    ) -> Result<Vec<f64>, FileError> {
        self.matrix(shape, SIZE * shape[1], number)
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
