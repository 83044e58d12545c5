//! Grey PNG images of up to 16 bits. They state no unit, and their dots per inch are a printer's.

use std::fs::File;
use std::io::BufReader;

use png::{BitDepth, ColorType, Decoder, DecodingError, Reader, Transformations};

use super::bytes::{Bytes, Stream, checked_shape, with_capacity, zeros};
use super::numbers::{Decode, NumberRows, Numbers, decoded};
use crate::surface::error::FileError;
use crate::surface::matrix::{Map, Matrix};

/// First bytes of a file.
pub(super) const MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Most bytes of pixels that a byte of a compressed file can encode: LZW packs up to 3840 bytes
/// into a code of 12 bits, deflate 1032 into a byte.
pub(super) const LARGEST_RATIO: usize = 4096;

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
    let mut image = image.read_info().map_err(broken)?;
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
    let numbers = if image.info().interlaced {
        file.expect_held(shape)?;
        // Rows of an interlaced image come in seven passes.
        let mut pixels = zeros(shape[0] * shape[1] * size)?;
        image.next_frame(&mut pixels).map_err(broken)?;
        let mut values = with_capacity(shape)?;
        values.resize(shape[0] * shape[1], 0.0);
        decode(&pixels, &mut values);
        Numbers::Held(values)
    } else {
        Numbers::Rows(Box::new(ImageRows {
            image,
            line: vec![0; shape[1] * size],
            decode,
        }))
    };
    Ok(Matrix {
        grey: true,
        ..Matrix::new(numbers, shape)
    })
}

/// Rows of an image that is not interlaced.
struct ImageRows {
    image: Reader<BufReader<Stream>>,
    line: Vec<u8>,
    decode: Decode,
}

impl NumberRows for ImageRows {
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        let columns = self.image.info().width as usize;
        for row in values.chunks_exact_mut(columns) {
            self.image.read_row(&mut self.line).map_err(broken)?;
            (self.decode)(&self.line, row);
        }
        Ok(())
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
