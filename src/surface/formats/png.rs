//! Grey PNG images of up to 16 bits. They state no unit, and their dots per inch are a printer's.

use std::fs::File;
use std::io::BufReader;

use png::{BitDepth, ColorType, Decoder, DecodingError, Reader, Transformations};

use super::bytes::{Bytes, Opening, Stream, checked_shape};
use super::numbers::{Decode, NumberRows, Numbers, decoded};
use super::unordered::Unordered;
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix};

/// First bytes of a file.
pub(super) const MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Most bytes of pixels that a byte of a compressed file can encode: LZW packs up to 3840 bytes
/// into a code of 12 bits, deflate 1032 into a byte.
pub(super) const LARGEST_RATIO: usize = 4096;

/// The seven passes of an interlaced image, in each the first row and column and the steps to the next.
///
/// # Source
/// W3C, "Portable Network Graphics (PNG) Specification", 2nd edition (2003), section 8.2.
const PASSES: [[usize; 4]; 7] = [
    [0, 0, 8, 8],
    [0, 4, 8, 8],
    [4, 0, 8, 4],
    [0, 2, 4, 4],
    [2, 0, 4, 2],
    [0, 1, 2, 2],
    [1, 0, 2, 1],
];

/// Columns and rows of an image, from its header.
pub(super) fn claimed_points(file: BufReader<File>) -> Option<[usize; 2]> {
    let (columns, rows) = Decoder::new(file).read_header_info().ok()?.size();
    Some([columns as usize, rows as usize])
}

/// Reads an image; 0 is black and 1 white.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let mut image = Decoder::new(file.stream());
    // Shades of fewer bits as bytes.
    image.set_transformations(Transformations::EXPAND);
    let image = image.read_info().map_err(broken)?;
    let (columns, rows) = image.info().size();
    let shape = checked_shape(rows.into(), columns.into())?;
    let size = match image.output_color_type() {
        (ColorType::Grayscale, BitDepth::Eight) => 1,
        (ColorType::Grayscale, BitDepth::Sixteen) => 2,
        _ => return Err(not_grey()),
    };
    refuse_ratio(shape, size, file.length())?;
    let decode = if size == 1 {
        decoded(|[shade]| f64::from(shade) / f64::from(u8::MAX))
    } else {
        decoded(|shade| f64::from(u16::from_be_bytes(shade)) / f64::from(u16::MAX))
    };
    let line = vec![0; shape[1] * size];
    let rows = ImageRows {
        image,
        line,
        decode,
    };
    let numbers = match file.opening() {
        // No row is read.
        Opening::Glance => Numbers::Rows(Box::new(rows)),
        opening if rows.image.info().interlaced => rows.interlaced(shape, opening)?,
        _ => Numbers::Rows(Box::new(rows)),
    };
    Ok(Matrix {
        grey: true,
        ..Matrix::new(numbers, shape)
    })
}

/// Rows of an image, as they come.
struct ImageRows {
    image: Reader<BufReader<Stream>>,
    line: Vec<u8>,
    decode: Decode,
}

impl ImageRows {
    /// The next row, or that of a pass, of as many pixels as there are values.
    fn row(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        self.image.read_row(&mut self.line).map_err(broken)?;
        (self.decode)(&self.line, values);
        Ok(())
    }

    /// The numbers of an interlaced image, of which those of a row come in several passes.
    fn interlaced(
        mut self,
        [rows, columns]: [usize; 2],
        opening: Opening,
    ) -> Result<Numbers, FileError> {
        let mut unordered = Unordered::new([rows, columns], opening)?;
        let mut shades = vec![0.0; columns];
        for [first_row, first_column, rows_on, columns_on] in PASSES {
            let places = (first_column..columns).step_by(columns_on);
            // Where the image is too narrow for a pass, it has no rows.
            if places.len() == 0 {
                continue;
            }
            let shades = &mut shades[..places.len()];
            for row in (first_row..rows).step_by(rows_on) {
                self.row(shades)?;
                for (column, shade) in places.clone().zip(&*shades) {
                    unordered.put(row * columns + column, *shade)?;
                }
            }
        }
        Ok(unordered.numbers())
    }
}

impl NumberRows for ImageRows {
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        let columns = self.image.info().width as usize;
        values
            .chunks_exact_mut(columns)
            .try_for_each(|row| self.row(row))
    }
}

/// Refuses an image of more pixels than a file of `length` bytes can encode.
pub(super) fn refuse_ratio(
    [rows, columns]: [usize; 2],
    size: usize,
    length: usize,
) -> Result<(), FileError> {
    let expected = (rows * columns * size).div_ceil(LARGEST_RATIO);
    if expected > length {
        return Err(FileError::Truncated {
            rows,
            columns,
            expected: expected as u64,
            found: length as u64,
        });
    }
    Ok(())
}

/// The error for colour images.
pub(super) fn not_grey() -> FileError {
    FileError::NotSupported {
        what: "images other than grey ones of 8 or 16 bits",
        instead: "colours are not heights: save it as a grey image, without transparency",
    }
}

fn broken(error: DecodingError) -> FileError {
    FileError::BrokenImage {
        format: "PNG",
        what: first_line(&error.to_string()),
    }
}

/// A decoder's message, on one line.
pub(super) fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().to_owned()
}
