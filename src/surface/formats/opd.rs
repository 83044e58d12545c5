//! Wyko's maps (.opd) of Veeco's and Bruker's interferometers: a directory of named blocks, then the blocks.
//!
//! # Source
//! Veeco, "Wyko Vision data file formats", the OPD format.

use super::bytes::{Bytes, checked_shape};
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// First bytes of a file.
pub(super) const MAGIC: &[u8] = b"\x01\0Directory";

/// Bytes of an entry of the directory, and of its name.
const ENTRY: usize = 24;
const NAME: usize = 16;

/// Names of blocks of heights.
const HEIGHTS: [&str; 4] = ["RAW DATA", "RAW_DATA", "OPD", "Raw"];

/// Bytes before the heights of a block: columns, rows and bytes of a number.
const HEIGHTS_HEADER: usize = 6;

/// Numbers from here on are missing heights: in 16 bits, and in single precision.
const MISSING_INTEGER: i16 = 32766;
const MISSING: f32 = 1e38;

/// Reads the first block of heights.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let mut file = file.named(".opd");
    file.take(2, "the header")?;
    let (_, length) = entry(&mut file)?;
    let mut blocks = Vec::new();
    for _ in 1..length / ENTRY {
        blocks.push(entry(&mut file)?);
    }
    let (mut wavelength, mut multiplier, mut aspect, mut pixel) = (None, 1.0, 1.0, None);
    let mut heights = None;
    for (name, length) in blocks.iter().filter(|(_, length)| *length > 0) {
        let start = file.offset();
        let what = "a block";
        let is_heights = HEIGHTS.contains(&name.as_str());
        let least = match name.as_str() {
            "Wavelength" | "Aspect" | "Pixel_size" => 4,
            "Mult" => 2,
            _ if is_heights => HEIGHTS_HEADER,
            _ => 0,
        };
        if *length < least {
            let what = format!("its block {name} has {length} bytes of {least} at least");
            return Err(file.broken(start, what));
        }
        match name.as_str() {
            "Wavelength" => wavelength = Some(f64::from(file.f32(what)?)),
            "Mult" => multiplier = f64::from(file.u16(what)?),
            "Aspect" => aspect = f64::from(file.f32(what)?),
            "Pixel_size" => pixel = Some(f64::from(file.f32(what)?)),
            _ if is_heights && heights.is_none() => heights = Some((start, name, *length)),
            _ => {}
        }
        file.seek(start.saturating_add(*length), "the next block")?;
    }
    let (Some((start, name, length)), Some(wavelength)) = (heights, wavelength) else {
        return Err(file.broken(0, "it has no block of heights, or no wavelength"));
    };
    file.seek(start, "the heights")?;
    let columns = file.u16("the number of columns")?;
    let rows = file.u16("the number of rows")?;
    let place = file.offset();
    let bytes_of_a_number = file.u16("the bytes of a number")?;
    let shape = checked_shape(rows.into(), columns.into())?;
    let [rows, columns] = shape;
    let needed = HEIGHTS_HEADER + rows * columns * usize::from(bytes_of_a_number);
    if length < needed {
        let what = format!(
            "its block {name} has {length} bytes, and {columns} x {rows} heights take {needed}"
        );
        return Err(file.broken(start, what));
    }
    // Heights in nm; a column is stored at a time.
    let step = 1e-9 * wavelength / multiplier;
    let values = match bytes_of_a_number {
        2 => file.by_columns(shape, move |number| match i16::from_le_bytes(number) {
            MISSING_INTEGER.. => f64::NAN,
            number => step * f64::from(number),
        })?,
        4 => file.by_columns(shape, move |number| {
            let number = f32::from_le_bytes(number);
            if number < MISSING {
                step * f64::from(number)
            } else {
                f64::NAN
            }
        })?,
        other => {
            let what = format!("numbers of {other} bytes; 2 and 4 are known");
            return Err(file.broken(place, what));
        }
    };
    let is_length = |length: &f64| length.is_finite() && *length > 0.0;
    let pixel = pixel.map(|pixel| [1e-3 * pixel, 1e-3 * pixel * aspect]);
    let size = pixel
        .filter(|sides| sides.iter().all(is_length))
        .map(|[dx, dy]| Size::Metres([dx * columns as f64, dy * rows as f64]));
    Ok(Matrix {
        size,
        unit: Some(1.0),
        ..Matrix::new(values, shape)
    })
}

/// Name and length of a block, from the directory.
fn entry(file: &mut Bytes) -> Result<(String, usize), FileError> {
    let name = file.text(NAME, "the directory")?;
    file.take(2, "the directory")?;
    let place = file.offset();
    let length = file.i32("the directory")?;
    file.take(2, "the directory")?;
    let length = usize::try_from(length)
        .map_err(|_| file.broken(place, format!("a block of {length} bytes")))?;
    Ok((name, length))
}
