//! The numbers of a map as its file gives them: some rows at a time, in their order. The whole map is all of its rows.

use super::bytes::{Bytes, with_capacity};
use crate::surface::file_error::FileError;

/// Most numbers read at once; some formats hold twice as many.
const AT_ONCE: usize = 1 << 17;

/// Turns the bytes of some numbers into these.
pub(super) type Decode = Box<dyn Fn(&[u8], &mut [f64])>;

/// Numbers one after another, of so many bytes each.
pub(super) fn decoded<const SIZE: usize>(number: impl Fn([u8; SIZE]) -> f64 + 'static) -> Decode {
    Box::new(move |bytes, values| {
        let (elements, _) = bytes.as_chunks::<SIZE>();
        for (value, element) in values.iter_mut().zip(elements) {
            *value = number(*element);
        }
    })
}

/// What gives the rows of a map from the first to the last.
pub(in crate::surface) trait NumberRows {
    /// The next rows, as many as the list holds.
    ///
    /// # Errors
    /// The file cannot be read, or holds something else.
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError>;
}

/// The numbers of a map, unscaled.
pub(in crate::surface) enum Numbers {
    /// Of a format that gives them only together.
    Held(Vec<f64>),
    /// Still in the file.
    Rows(Box<dyn NumberRows>),
}

impl Numbers {
    /// All numbers of a map.
    ///
    /// # Errors
    /// The file cannot be read, and too little memory.
    pub fn all(self, shape: [usize; 2]) -> Result<Vec<f64>, FileError> {
        let mut rows = match self {
            Numbers::Held(values) => return Ok(values),
            Numbers::Rows(rows) => rows,
        };
        let mut values = with_capacity(shape)?;
        values.resize(shape[0] * shape[1], 0.0);
        rows.next(&mut values)?;
        Ok(values)
    }

    /// Its rows one after another.
    pub fn into_rows(self) -> Box<dyn NumberRows> {
        match self {
            Numbers::Held(values) => Box::new(HeldRows { values, given: 0 }),
            Numbers::Rows(rows) => rows,
        }
    }

    /// These numbers without those that `cover` covers: where it has more than a half they are missing.
    pub fn covered(self, cover: Numbers, columns: usize) -> Numbers {
        Numbers::Rows(Box::new(CoveredRows {
            rows: self.into_rows(),
            cover: cover.into_rows(),
            columns,
        }))
    }
}

/// Numbers in memory.
struct HeldRows {
    values: Vec<f64>,
    given: usize,
}

impl NumberRows for HeldRows {
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        let end = self.given + values.len();
        values.copy_from_slice(&self.values[self.given..end]);
        self.given = end;
        Ok(())
    }
}

/// The order in which rows and columns are stored.
enum Order {
    Plain,
    /// Each row from its end.
    ReversedRows,
    /// The last row first.
    LastRowFirst,
    /// Column after column.
    Columns,
}

/// Lines of numbers of a fixed number of bytes.
pub(super) struct RawRows {
    /// From the first number on.
    file: Bytes,
    /// Lines, and numbers in each, as they are stored.
    lines: [usize; 2],
    /// Bytes of a number, and from line to line.
    steps: [usize; 2],
    order: Order,
    decode: Decode,
    /// Rows given so far.
    given: usize,
}

impl RawRows {
    /// Lines from the place of the file on; `steps` are the bytes of a number and those from line to line.
    pub fn new<const SIZE: usize>(
        file: Bytes,
        lines: [usize; 2],
        steps: [usize; 2],
        number: impl Fn([u8; SIZE]) -> f64 + 'static,
    ) -> RawRows {
        RawRows {
            file,
            lines,
            steps,
            order: Order::Plain,
            decode: decoded(number),
            given: 0,
        }
    }

    /// The lines are columns.
    pub fn transposed(self) -> RawRows {
        RawRows {
            order: Order::Columns,
            ..self
        }
    }

    /// Each row is stored from its end.
    pub fn reversed_rows(self) -> RawRows {
        RawRows {
            order: Order::ReversedRows,
            ..self
        }
    }

    /// The last row is stored first.
    pub fn last_row_first(self) -> RawRows {
        RawRows {
            order: Order::LastRowFirst,
            ..self
        }
    }

    /// Reads numbers of a line from one of them on.
    fn read(
        &mut self,
        line: usize,
        from: usize,
        buffer: &mut Vec<u8>,
        values: &mut [f64],
    ) -> Result<(), FileError> {
        let [size, stride] = self.steps;
        buffer.resize(values.len() * size, 0);
        let mut file = self.file.clone();
        file.skip(line * stride + from * size, "the heights")?;
        file.fill(buffer)?;
        (self.decode)(buffer, values);
        Ok(())
    }
}

impl NumberRows for RawRows {
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        let [lines, length] = self.lines;
        let mut buffer = Vec::new();
        if let Order::Columns = self.order {
            let count = values.len() / lines;
            let mut column = vec![0.0; count];
            for line in 0..lines {
                self.read(line, self.given, &mut buffer, &mut column)?;
                for (row, value) in values.chunks_exact_mut(lines).zip(&column) {
                    row[line] = *value;
                }
            }
            self.given += count;
            return Ok(());
        }
        for row in values.chunks_exact_mut(length) {
            let line = match self.order {
                Order::LastRowFirst => lines - 1 - self.given,
                _ => self.given,
            };
            self.read(line, 0, &mut buffer, row)?;
            if let Order::ReversedRows = self.order {
                row.reverse();
            }
            self.given += 1;
        }
        Ok(())
    }
}

impl From<RawRows> for Numbers {
    fn from(rows: RawRows) -> Numbers {
        Numbers::Rows(Box::new(rows))
    }
}

/// Numbers of which some are covered.
struct CoveredRows {
    rows: Box<dyn NumberRows>,
    cover: Box<dyn NumberRows>,
    columns: usize,
}

impl NumberRows for CoveredRows {
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        let at_once = (AT_ONCE / self.columns).max(1) * self.columns;
        let mut cover = vec![0.0; at_once.min(values.len())];
        for values in values.chunks_mut(at_once) {
            let cover = &mut cover[..values.len()];
            self.rows.next(values)?;
            self.cover.next(cover)?;
            for (value, cover) in values.iter_mut().zip(cover) {
                if *cover > 0.5 {
                    *value = f64::NAN;
                }
            }
        }
        Ok(())
    }
}
