//! Grey PNG images of up to 16 bits. They state no unit, and their dots per inch are a printer's.

use std::fs::File;
use std::io::{BufReader, Cursor};

use image::codecs::png::PngDecoder;
use image::{ColorType, ImageDecoder};

use super::bytes::{checked_shape, with_capacity};
use crate::surface::error::FileError;
use crate::surface::matrix::Matrix;

/// First bytes of a file.
pub(super) const MAGIC: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Most bytes of pixels that a byte of a compressed file can encode: LZW packs up to 3840 bytes
/// into a code of 12 bits, deflate 1032 into a byte.
pub(super) const LARGEST_RATIO: usize = 4096;

/// Columns and rows of an image, from its header.
pub(super) fn claimed_points(file: BufReader<File>) -> Option<[usize; 2]> {
    let (columns, rows) = PngDecoder::new(file).ok()?.dimensions();
    Some([columns as usize, rows as usize])
}

/// Reads an image; 0 is black and 1 white.
pub(super) fn read(bytes: &[u8]) -> Result<Matrix, FileError> {
    let image = PngDecoder::new(Cursor::new(bytes)).map_err(broken)?;
    let (columns, rows) = image.dimensions();
    let shape = checked_shape(rows.into(), columns.into())?;
    let colours = image.color_type();
    let size = match colours {
        ColorType::L8 => 1,
        ColorType::L16 => 2,
        _ => return Err(not_grey()),
    };
    refuse_ratio(shape, size, bytes.len())?;
    // The decoder needs a byte buffer; it stores 16-bit numbers in the machine's byte order.
    let mut pixels = Vec::new();
    let length = shape[0] * shape[1] * size;
    pixels
        .try_reserve_exact(length)
        .map_err(|_| FileError::Memory {
            bytes: length as u64,
        })?;
    pixels.resize(length, 0);
    image.read_image(&mut pixels).map_err(broken)?;
    let mut values = with_capacity(shape)?;
    if size == 1 {
        values.extend(
            pixels
                .iter()
                .map(|shade| f64::from(*shade) / f64::from(u8::MAX)),
        );
    } else {
        values.extend(pixels.chunks_exact(2).map(|shade| {
            f64::from(u16::from_ne_bytes([shade[0], shade[1]])) / f64::from(u16::MAX)
        }));
    }
    Ok(Matrix {
        grey: true,
        ..Matrix::new(values, shape)
    })
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

fn broken(error: image::ImageError) -> FileError {
    FileError::BrokenImage {
        format: "PNG",
        what: first_line(&error.to_string()),
    }
}

/// A decoder's message, on one line.
pub(super) fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().to_owned()
}
