//! Igor binary waves (.ibw) of version 5, as Asylum Research's microscopes write them.
//!
//! A header of 384 bytes, the numbers with x fastest and one layer a channel, then a note and the names of
//! the channels. Reads the first channel of heights.
//!
//! # Source
//! WaveMetrics, "Igor Pro technical note PTN003".

use super::bytes::{Bytes, checked_shape};
use super::length::{length_unit, stated_unit};
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// First bytes of a file: the version, as a PC stores it.
pub(super) const MAGIC: &[u8] = b"\x05\0";

/// Name of the format in messages.
const FORMAT: &str = ".ibw";

/// Offset of the header of the wave, and of its numbers.
const WAVE: usize = 64;
const NUMBERS: usize = 384;

/// Bytes of a channel's name.
const LABEL: usize = 32;

/// What the names of channels of heights begin with, lower case.
const HEIGHTS: [&str; 2] = ["height", "zsensor"];

/// Types of numbers.
const SINGLE: i16 = 0x02;
const DOUBLE: i16 = 0x04;
const INT_8: i16 = 0x08;
const INT_16: i16 = 0x10;
const INT_32: i16 = 0x20;
const UNSIGNED: i16 = 0x40;

/// Reads the first channel of heights, else the first one.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let mut file = file.named(FORMAT);
    // Version, checksum and length of the wave; then the lengths of what follows the numbers.
    file.take(8, "the header")?;
    let mut tail = [0; 11];
    for length in &mut tail {
        *length = file.u32("the lengths of the parts")? as usize;
    }
    file.seek(WAVE, "the wave")?;
    file.take(4 + 4 + 4, "the dates")?;
    let count = file.i32("the number of points")?;
    let place = file.offset();
    let kind = file.i16("the type of the numbers")?;
    file.take(2 + 6 + 2 + 32 + 4 + 4, "the name of the wave")?;
    let mut dimensions = [0_i64; 4];
    for dimension in &mut dimensions {
        *dimension = file.i32("the dimensions")?.into();
    }
    let steps: [f64; 4] = file.doubles("the steps")?;
    file.doubles::<4>("the offsets")?;
    let mut units = [const { String::new() }; 3];
    for unit in &mut units {
        *unit = file.text(4, "the units")?;
    }
    let [columns, rows, layers, blocks] = dimensions;
    let shape = checked_shape(rows, columns)?;
    let points = shape[0] * shape[1];
    let layers = usize::try_from(layers.max(1)).unwrap_or(1);
    if blocks > 1 || points.checked_mul(layers) != usize::try_from(count).ok() {
        let what = format!("{count} numbers as {columns} x {rows} x {layers} x {blocks} points");
        return Err(file.broken(place, what));
    }
    let size_of_number = match kind & !UNSIGNED {
        INT_8 => 1,
        INT_16 => 2,
        SINGLE | INT_32 => 4,
        DOUBLE => 8,
        other => {
            return Err(file.broken(place, format!("numbers of the unknown type {other}")));
        }
    };
    let labels = labels(
        &file,
        NUMBERS + points * layers * size_of_number,
        &tail,
        layers,
    );
    let is_height = |label: &String| {
        let label = label.to_ascii_lowercase();
        HEIGHTS.iter().any(|name| label.starts_with(name))
    };
    let layer = labels.iter().position(is_height).unwrap_or(0);
    file.seek(NUMBERS + layer * points * size_of_number, "the heights")?;
    let unsigned = kind & UNSIGNED != 0;
    let values = match kind & !UNSIGNED {
        INT_8 if unsigned => file.packed(shape, |number| u8::from_le_bytes(number).into())?,
        INT_8 => file.packed(shape, |number| i8::from_le_bytes(number).into())?,
        INT_16 if unsigned => file.packed(shape, |number| u16::from_le_bytes(number).into())?,
        INT_16 => file.packed(shape, |number| i16::from_le_bytes(number).into())?,
        INT_32 if unsigned => file.packed(shape, |number| u32::from_le_bytes(number).into())?,
        INT_32 => file.packed(shape, |number| i32::from_le_bytes(number).into())?,
        SINGLE => file.packed(shape, |number| f32::from_le_bytes(number).into())?,
        _ => file.packed(shape, f64::from_le_bytes)?,
    };
    let [heights, x, y] = &units;
    let side = |axis: usize, unit: &str| {
        let side = steps[axis].abs() * [columns, rows][axis] as f64 * length_unit(unit)?;
        (side.is_finite() && side > 0.0).then_some(side)
    };
    let size = side(0, x).zip(side(1, y));
    let mut matrix = Matrix {
        size: size.map(|(x, y)| Size::Metres([x, y])),
        unit: stated_unit(heights, "heights")?,
        ..Matrix::new(values, shape)
    };
    let others = labels.iter().filter(|label| is_height(label)).count();
    if others > 1 || (layers > 1 && others == 0) {
        let name = labels.get(layer).map_or("without a name", String::as_str);
        matrix.warnings.push(format!(
            "the file holds {} channels{}; the first, {name}, is read",
            if others > 1 { others } else { layers },
            if others > 1 { " of heights" } else { "" },
        ));
    }
    Ok(matrix)
}

/// The names of the layers, which follow the formula, the note, the long units and the names of x and y.
fn labels(file: &Bytes, end: usize, tail: &[usize; 11], layers: usize) -> Vec<String> {
    let [formula, note, units @ ..] = *tail;
    let [unit, ux, uy, uz, ut, x, y, length, ..] = units;
    let before = [formula, note, unit, ux, uy, uz, ut, x, y];
    let start = before
        .iter()
        .try_fold(end, |sum: usize, length| sum.checked_add(*length));
    let names = start.and_then(|start| {
        let mut file = file.clone();
        file.seek(start, "the names").ok()?;
        file.take(length, "the names").ok()
    });
    // The first name is that of the axis itself.
    let names = names.unwrap_or_default();
    let names = names.chunks_exact(LABEL).skip(1);
    names
        .take(layers)
        .map(|name| {
            let name = name.split(|byte| *byte == 0).next().unwrap_or_default();
            String::from_utf8_lossy(name).trim().to_owned()
        })
        .collect()
}
