//! Bruker's Nanoscope images (.spm, .001 and so on; before: Veeco, Digital Instruments), from version 4.3.
//!
//! A header of text in sections, then blocks of integers. Reads the first image of lengths that is named as one of heights, else the first
//! of lengths.
//!
//! # Source
//! Digital Instruments, "Nanoscope file formats", and the headers of files of versions 5 to 10.

use super::bytes::{Bytes, checked_shape};
use super::instrument_header::{NANOSCOPE_IMAGES, Section, nanoscope_sections, sensitivity, volts};
use super::length::length_unit;
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// First bytes of a file of images.
pub(super) const MAGIC: &[u8] = NANOSCOPE_IMAGES;

/// Longest header read; a header has some hundred lines of text.
const LONGEST_HEADER: usize = 1 << 24;

/// Name of the format in messages.
const FORMAT: &str = "Nanoscope";

/// Words in the names of images of heights, lower case. Calibrated deflections and deformations are lengths too.
const HEIGHTS: [&str; 2] = ["height", "zsensor"];

/// Reads the first image of heights.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let mut file = file.named(FORMAT);
    let sections = nanoscope_sections(&file.beginning(LONGEST_HEADER)?);
    let images: Vec<&Section> = sections
        .iter()
        .filter(|section| section.name == "ciao image list")
        .collect();
    if images.is_empty() {
        return Err(file.broken(0, "its header names no image (\"Ciao image list\")"));
    }
    let is_length = |image: &&Section| height_step(image, &sections).is_some();
    let lengths: Vec<&Section> = images.iter().copied().filter(is_length).collect();
    let Some(first) = lengths.first() else {
        return Err(FileError::NotALength {
            what: "heights",
            unit: images[0].find("@2:image data").unwrap_or("").to_owned(),
        });
    };
    let mut heights = lengths.iter().filter(|image| is_named_height(image));
    let image = heights.next().unwrap_or(first);
    let number = |key: &str| {
        let value = image.find(key).and_then(|value| value.parse::<i64>().ok());
        value.ok_or_else(|| file.broken(0, format!("an image has no whole number as {key:?}")))
    };
    let shape = checked_shape(number("number of lines")?, number("samps/line")?)?;
    let [rows, columns] = shape;
    // From version 9.2 on two bytes of resolution are stored in four.
    let resolution = number("bytes/pixel")?;
    let length = number("data length")?;
    let stored = length / (rows * columns) as i64;
    if stored < 2 {
        let what = format!("{length} bytes for an image of {columns} x {rows} points");
        return Err(file.broken(0, what));
    }
    let start = usize::try_from(number("data offset")?).unwrap_or(usize::MAX);
    if !(resolution == 2 || resolution == 4) {
        return Err(file.broken(
            0,
            format!("numbers of {resolution} bytes; 2 or 4 are known"),
        ));
    }
    file.seek(start, "the image")?;
    let step = height_step(image, &sections).unwrap_or(f64::NAN) / 256_f64.powi(resolution as i32);
    let values = match stored {
        4.. => file.packed(shape, move |number| {
            step * f64::from(i32::from_le_bytes(number))
        })?,
        _ => file.packed(shape, move |number| {
            step * f64::from(i16::from_le_bytes(number))
        })?,
    };
    let mut matrix = Matrix {
        size: size(image, &sections, shape).map(Size::Metres),
        unit: Some(1.0),
        ..Matrix::new(values, shape)
    };
    let others = heights.count();
    // `S [ZSensor] "Height Sensor"`
    let name = image
        .find("@2:image data")
        .and_then(|name| name.split('"').nth(1))
        .unwrap_or("without a name");
    if others > 0 {
        matrix.warnings.push(format!(
            "the file holds {} images of heights; the first, {name}, is read",
            others + 1
        ));
    } else if !is_named_height(image) {
        matrix.warnings.push(format!(
            "the file names no image as one of heights; the first of lengths, {name}, is read"
        ));
    }
    Ok(matrix)
}

fn is_named_height(image: &Section) -> bool {
    let name = image.find("@2:image data").unwrap_or_default();
    let name = name.to_ascii_lowercase();
    HEIGHTS.iter().any(|word| name.contains(word))
}

/// Height of the whole range of an image's integers, m: `V [Sens. Zsens] (0.0067 V/LSB) 440 V`, of which the last number is
/// the range. `None` where that is no length.
fn height_step(image: &Section, sections: &[Section]) -> Option<f64> {
    let scale = image.find("@2:z scale")?;
    let range = volts(scale.rsplit_once(')')?.1)?;
    let step = range * sensitivity(scale, sections)?;
    step.is_finite().then_some(step)
}

/// Sides of an image, m. Of one that is longer along one axis, or was ended early, the scan size may be that of the square it lies in.
///
/// # Source
/// Gwyddion, `nanoscope.c`, where it is said to be known from files.
fn size(image: &Section, sections: &[Section], [rows, columns]: [usize; 2]) -> Option<[f64; 2]> {
    let [x, y] = scan_size(image.find("scan size")?)?;
    if x != y || is_square(image) {
        return Some([x, y]);
    }
    let scan = sections
        .iter()
        .find(|section| section.name == "ciao scan list");
    let lines = match scan {
        Some(scan) if is_square(scan) => scan.find("lines").and_then(|lines| lines.parse().ok()),
        // Square pixels.
        Some(_) => Some(columns),
        None => None,
    };
    let lines = lines.filter(|lines| *lines > 0).unwrap_or(rows);
    Some([x, y * rows as f64 / lines as f64])
}

/// Whether the sides of an image or a scan are equal, `1:1`.
fn is_square(section: &Section) -> bool {
    let ratio = section
        .find("aspect ratio")
        .and_then(|ratio| ratio.split_once(':'));
    ratio.is_none_or(|(one, other)| one.trim() == other.trim())
}

/// Sides of a scan, m: `500 500 nm`, or `500 nm` for both.
fn scan_size(text: &str) -> Option<[f64; 2]> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let (x, y, unit) = match words[..] {
        [x, y, unit] => (x, y, unit),
        [x, unit] => (x, x, unit),
        _ => return None,
    };
    let unit = length_unit(unit)?;
    Some([x.parse::<f64>().ok()? * unit, y.parse::<f64>().ok()? * unit])
}
