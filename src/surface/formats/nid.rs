//! Nanosurf images (.nid): a header of text in sections, then blocks of integers.
//!
//! Reads the first channel of lengths that is named as one of heights, else the first of lengths.
//!
//! # Source
//! Nanosurf, "NID file format", and the headers of version 2.

use super::bytes::{Bytes, checked_shape};
use super::instrument_header::{Section, bracketed_sections};
use super::length::length_unit;
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// First bytes of a file.
pub(super) const MAGIC: &[u8] = b"[DataSet]";

/// Name of the format in messages.
const FORMAT: &str = ".nid";

/// Longest header read; a header has some hundred lines of text.
const LONGEST_HEADER: usize = 1 << 24;

/// What the names of channels of heights begin with, lower case. Calibrated deflections and amplitudes are lengths too.
const HEIGHTS: [&str; 3] = ["z-axis", "topography", "height"];

/// What stands between the header and the numbers.
const END: &[u8] = b"#!";

/// A number of a section.
fn number<T: std::str::FromStr>(
    section: &Section,
    file: &Bytes,
    key: &str,
) -> Result<T, FileError> {
    let value = section
        .find(key)
        .and_then(|value| value.trim().parse().ok());
    let what = || format!("[{}] has no such number as {key}", section.name);
    value.ok_or_else(|| file.broken(0, what()))
}

/// Bits of a number, and the shape.
fn layout(section: &Section, file: &Bytes) -> Result<(u32, [usize; 2]), FileError> {
    let bits: u32 = number(section, file, "SaveBits")?;
    if ![8, 16, 32].contains(&bits) {
        let what = format!("numbers of {bits} bits; 8, 16 and 32 are known");
        return Err(file.broken(0, what));
    }
    let shape = checked_shape(
        number(section, file, "Lines")?,
        number(section, file, "Points")?,
    )?;
    Ok((bits, shape))
}

/// Reads the first channel of heights.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let mut file = file.named(FORMAT);
    let bytes = file.beginning(LONGEST_HEADER)?;
    let end = bytes.windows(END.len()).position(|word| word == END);
    let Some(end) = end else {
        return Err(file.broken(bytes.len(), "its header has no end (\"#!\")"));
    };
    let sections = bracketed_sections(&bytes[..end]);
    let channels = channels(&sections);
    let length = |channel: &&Section| channel.find("Dim2Unit").and_then(length_unit);
    let is_named = |channel: &&Section| {
        let name = channel.find("Dim2Name").unwrap_or_default();
        let name = name.trim().to_ascii_lowercase();
        HEIGHTS.iter().any(|start| name.starts_with(start))
    };
    let named = channels
        .iter()
        .position(|channel| length(channel).is_some() && is_named(channel));
    let of_lengths = || {
        channels
            .iter()
            .position(|channel| length(channel).is_some())
    };
    let Some(first) = named.or_else(of_lengths) else {
        let unit = channels
            .first()
            .and_then(|channel| channel.find("Dim2Unit"));
        return Err(match unit {
            None => file.broken(end, "it holds no channel"),
            Some(unit) => FileError::NotALength {
                what: "heights",
                unit: unit.to_owned(),
            },
        });
    };
    let mut start = end + END.len();
    for before in &channels[..first] {
        let (bits, [rows, columns]) = layout(before, &file)?;
        start = start.saturating_add(bits as usize / 8 * rows * columns);
    }
    file.seek(start, "the heights")?;
    let channel = channels[first];
    let (bits, shape) = layout(channel, &file)?;
    let [rows, columns] = shape;
    let (least, range): (f64, f64) = (
        number(channel, &file, "Dim2Min")?,
        number(channel, &file, "Dim2Range")?,
    );
    // The least integer is the least height, one more than the greatest the end of the range.
    let signed = channel.find("SaveSign") != Some("Unsigned");
    let zero = if signed {
        2_f64.powi(bits as i32 - 1)
    } else {
        0.0
    };
    let height = move |number: i64| {
        let number = match (signed, bits) {
            (true, _) => number,
            (false, bits) => number & ((1 << bits) - 1),
        };
        least + range * ((number as f64 + zero) / 2_f64.powi(bits as i32))
    };
    let values = match bits {
        8 => file.packed(shape, move |number| {
            height(i8::from_le_bytes(number).into())
        })?,
        16 => file.packed(shape, move |number| {
            height(i16::from_le_bytes(number).into())
        })?,
        _ => file.packed(shape, move |number| {
            height(i32::from_le_bytes(number).into())
        })?,
    };
    let side = |axis: usize| {
        let unit = channel
            .find(&format!("Dim{axis}Unit"))
            .and_then(length_unit)?;
        let side: f64 = number(channel, &file, &format!("Dim{axis}Range")).ok()?;
        let side = side.abs() * unit;
        (side.is_finite() && side > 0.0).then_some(side)
    };
    let mut matrix = Matrix {
        size: side(0).zip(side(1)).map(|(x, y)| Size::Metres([x, y])),
        unit: length(&channel),
        ..Matrix::new(values, [rows, columns])
    };
    let others = channels
        .iter()
        .filter(|channel| length(channel).is_some() && is_named(channel))
        .count();
    let word = |key: &str| channel.find(key).unwrap_or_default();
    let (name, frame) = (word("Dim2Name"), word("Frame"));
    if others > 1 {
        matrix.warnings.push(format!(
            "the file holds {others} channels of heights; the first, {name} of {frame}, is read"
        ));
    } else if others == 0 {
        matrix.warnings.push(format!(
            "the file names no channel as one of heights; the first of lengths, {name} of {frame}, is read"
        ));
    }
    Ok(matrix)
}

/// The channels in the order of their numbers: that of the groups in the first section.
fn channels(sections: &[Section]) -> Vec<&Section> {
    let listed = sections.first().map_or(&[][..], |first| first.entries());
    listed
        .iter()
        .filter(|(key, _)| key.starts_with("Gr") && key.contains("-Ch"))
        .filter_map(|(_, name)| sections.iter().find(|section| section.name == *name))
        .collect()
}
