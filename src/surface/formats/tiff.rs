//! Grey TIFF images: 8 or 16 bits a pixel as shades, 32 or 64 bits of floating point as heights.
//!
//! They state no unit, and their resolution is a printer's.

use std::fs::File;
use std::io::{BufReader, Cursor};

use tiff::ColorType;
use tiff::decoder::{Decoder, DecodingResult, Limits};

use super::bytes::{checked_shape, with_capacity};
use super::png::{first_line, not_grey, refuse_ratio};
use crate::surface::error::FileError;
use crate::surface::matrix::Matrix;

/// First bytes of a file: both byte orders, and files beyond 4 GiB.
pub(super) const MAGIC: [&[u8]; 4] = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];

/// Room for the decoder's own tables, bytes.
const TABLES: usize = 1 << 20;

/// Columns and rows of the first image, from its directory.
pub(super) fn claimed_points(file: BufReader<File>) -> Option<[usize; 2]> {
    let (columns, rows) = Decoder::new(file).ok()?.dimensions().ok()?;
    Some([columns as usize, rows as usize])
}

/// Reads the first image of a file.
pub(super) fn read(bytes: &[u8]) -> Result<Matrix, FileError> {
    let mut image = Decoder::new(Cursor::new(bytes)).map_err(broken)?;
    let (columns, rows) = image.dimensions().map_err(broken)?;
    let shape = checked_shape(rows.into(), columns.into())?;
    let bits = match image.colortype().map_err(broken)? {
        ColorType::Gray(bits @ (8 | 16 | 32 | 64)) => bits,
        _ => return Err(not_grey()),
    };
    let size = usize::from(bits / 8);
    refuse_ratio(shape, size, bytes.len())?;
    let mut limits = Limits::default();
    limits.decoding_buffer_size = shape[0] * shape[1] * size;
    limits.intermediate_buffer_size = shape[0] * shape[1] * size + TABLES;
    let mut image = image.with_limits(limits);
    let pixels = image.read_image().map_err(broken)?;
    let mut values = with_capacity(shape)?;
    let grey = match pixels {
        DecodingResult::U8(shades) => {
            values.extend(
                shades
                    .iter()
                    .map(|shade| f64::from(*shade) / f64::from(u8::MAX)),
            );
            true
        }
        DecodingResult::U16(shades) => {
            values.extend(
                shades
                    .iter()
                    .map(|shade| f64::from(*shade) / f64::from(u16::MAX)),
            );
            true
        }
        DecodingResult::F32(heights) => {
            values.extend(heights.iter().map(|height| f64::from(*height)));
            false
        }
        DecodingResult::F64(heights) => {
            values.extend(heights);
            false
        }
        _ => return Err(not_grey()),
    };
    if values.len() != shape[0] * shape[1] {
        return Err(not_grey());
    }
    let mut warnings = Vec::new();
    if image.more_images() {
        warnings.push("the file holds several images; the first is read".to_owned());
    }
    Ok(Matrix {
        grey,
        warnings,
        ..Matrix::new(values, shape)
    })
}

fn broken(error: tiff::TiffError) -> FileError {
    FileError::BrokenImage {
        format: "TIFF",
        what: first_line(&error.to_string()),
    }
}
