//! Numbers that a file gives in another order than that of rows: interlaced images, points in any order.
//!
//! One process holds them. Where several read a file by rows, they wait on disk, sorted by bands of rows.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};

use super::bytes::{Opening, with_capacity};
use super::numbers::{NumberRows, Numbers};
use crate::surface::file_error::FileError;
use crate::surface::matrix::PASSED;

/// Bytes of a number on disk: its place within the band, and itself.
const RECORD: usize = 16;

/// Bytes of a band that are written at once.
const BLOCK: usize = 4096 * RECORD;

/// The numbers of a map as they come.
pub(super) struct Unordered {
    shape: [usize; 2],
    /// A bit for each point, set where its number has come.
    come: Vec<u64>,
    numbers: Waiting,
}

/// Where numbers wait for the last to come.
enum Waiting {
    InMemory(Vec<f64>),
    OnDisk(Bands),
}

impl Unordered {
    /// No number of a map of this shape has come.
    ///
    /// # Errors
    /// Too little memory; no temporary file.
    pub fn new(shape: [usize; 2], opening: Opening) -> Result<Self, FileError> {
        let points = shape[0] * shape[1];
        let numbers = match opening {
            Opening::Whole => {
                let mut values = with_capacity(shape)?;
                values.resize(points, f64::NAN);
                Waiting::InMemory(values)
            }
            Opening::ByRows | Opening::Glance => Waiting::OnDisk(Bands::new(shape, PASSED)?),
        };
        Ok(Unordered {
            shape,
            come: vec![0; points.div_ceil(u64::BITS as usize)],
            numbers,
        })
    }

    /// Takes the number of a point, `row * columns + column`, unless it has come before; whether it is taken.
    ///
    /// # Errors
    /// The temporary file cannot be written.
    pub fn put(&mut self, point: usize, number: f64) -> Result<bool, FileError> {
        let bits = u64::BITS as usize;
        let (word, bit) = (&mut self.come[point / bits], 1 << (point % bits));
        if *word & bit != 0 {
            return Ok(false);
        }
        *word |= bit;
        match &mut self.numbers {
            Waiting::InMemory(values) => values[point] = number,
            Waiting::OnDisk(bands) => bands.put(point, number).map_err(unsorted)?,
        }
        Ok(true)
    }

    /// The numbers of all points; those that have not come are missing.
    pub fn numbers(self) -> Numbers {
        match self.numbers {
            Waiting::InMemory(values) => Numbers::Held(values),
            Waiting::OnDisk(bands) => Numbers::Rows(Box::new(BandRows {
                columns: self.shape[1],
                bands,
                band: Vec::new(),
                given: 0,
            })),
        }
    }
}

/// Numbers by bands of rows, in a temporary file without a name.
struct Bands {
    file: File,
    /// Bytes written so far.
    length: u64,
    /// Points of a band.
    points: usize,
    /// Points of the map.
    all: usize,
    bands: Vec<Band>,
}

/// The numbers of a band that have come.
#[derive(Default)]
struct Band {
    /// Records that are still to be written.
    waiting: Vec<u8>,
    /// Where the blocks written so far begin.
    blocks: Vec<u64>,
}

impl Bands {
    /// Bands of at most so many points, or of a row.
    fn new([rows, columns]: [usize; 2], most: usize) -> Result<Self, FileError> {
        let points = (most / columns).max(1) * columns;
        let mut bands = Vec::new();
        bands.resize_with((rows * columns).div_ceil(points), Band::default);
        Ok(Bands {
            file: tempfile::tempfile().map_err(unsorted)?,
            length: 0,
            points,
            all: rows * columns,
            bands,
        })
    }

    fn put(&mut self, point: usize, number: f64) -> io::Result<()> {
        let band = &mut self.bands[point / self.points];
        let within = (point % self.points) as u64;
        band.waiting.extend(within.to_le_bytes());
        band.waiting.extend(number.to_le_bytes());
        if band.waiting.len() == BLOCK {
            // Numbers are read only after the last has come, so that the file ends where the next block begins.
            self.file.write_all(&band.waiting)?;
            band.blocks.push(self.length);
            self.length += BLOCK as u64;
            band.waiting.clear();
        }
        Ok(())
    }

    /// The numbers of a band into `values`.
    fn read(&mut self, index: usize, values: &mut Vec<f64>) -> io::Result<()> {
        let length = self.points.min(self.all - index * self.points);
        values.clear();
        values.resize(length, f64::NAN);
        let band = std::mem::take(&mut self.bands[index]);
        let mut take = |records: &[u8]| {
            let (records, _) = records.as_chunks::<RECORD>();
            for record in records {
                let (place, number) = record.split_at(RECORD / 2);
                let place = place.try_into().map_or(usize::MAX, usize_of);
                if let (Some(value), Ok(number)) = (values.get_mut(place), number.try_into()) {
                    *value = f64::from_le_bytes(number);
                }
            }
        };
        take(&band.waiting);
        let mut block = band.waiting;
        block.resize(BLOCK, 0);
        for start in band.blocks {
            self.file.seek(SeekFrom::Start(start))?;
            self.file.read_exact(&mut block)?;
            take(&block);
        }
        Ok(())
    }
}

/// The error of a temporary file.
fn unsorted(source: io::Error) -> FileError {
    FileError::Sorting { source }
}

fn usize_of(bytes: [u8; RECORD / 2]) -> usize {
    u64::from_le_bytes(bytes) as usize
}

/// The rows of sorted numbers, of which one band is held.
struct BandRows {
    columns: usize,
    bands: Bands,
    /// The band in which the next row lies.
    band: Vec<f64>,
    /// Points given so far.
    given: usize,
}

impl NumberRows for BandRows {
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        for row in values.chunks_exact_mut(self.columns) {
            let within = self.given % self.bands.points;
            if within == 0 {
                let index = self.given / self.bands.points;
                let read = self.bands.read(index, &mut self.band);
                read.map_err(unsorted)?;
            }
            row.copy_from_slice(&self.band[within..within + self.columns]);
            self.given += self.columns;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that come from the last to the first, and of which some never come, on disk as in memory; several blocks a band.
    #[test]
    fn numbers_come_in_any_order() {
        let shape = [50, 300];
        let points = shape[0] * shape[1];
        let sorted = |mut unordered: Unordered| {
            // 7 and the number of points have no common divisor.
            for at in 0..points {
                let point = points - 1 - at * 7 % points;
                if point % 11 != 3 {
                    assert!(unordered.put(point, point as f64).unwrap());
                    assert!(!unordered.put(point, -1.0).unwrap());
                }
            }
            let mut rows = unordered.numbers().into_rows();
            let mut values = vec![0.0; points];
            let (first, last) = values.split_at_mut(13 * shape[1]);
            rows.next(first).unwrap();
            rows.next(last).unwrap();
            values
        };
        let of = |opening| Unordered::new(shape, opening).unwrap();
        let mut small = of(Opening::ByRows);
        // Four bands of 16 rows, the last of two; 4800 numbers are more than a block.
        small.numbers = Waiting::OnDisk(Bands::new(shape, 16 * shape[1] + 5).unwrap());
        for found in [
            sorted(of(Opening::Whole)),
            sorted(of(Opening::ByRows)),
            sorted(small),
        ] {
            for (point, value) in found.iter().enumerate() {
                let expected = if point % 11 == 3 {
                    f64::NAN
                } else {
                    point as f64
                };
                assert_eq!(value.to_bits(), expected.to_bits(), "{point}");
            }
        }
    }
}
