//! Bruker's Nanoscope images (.spm, .001 and so on; before: Veeco, Digital Instruments), from version 4.3.
//!
//! A header of text in sections, then blocks of integers. Reads the first image whose heights are lengths.
//!
//! # Source
//! Digital Instruments, "Nanoscope file formats", and the headers of files of versions 5 to 10.

use super::bytes::{Bytes, checked_shape};
use super::instrument_header::{NANOSCOPE_IMAGES, Section, nanoscope_sections, sensitivity, volts};
use super::length::length_unit;
use crate::surface::error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// First bytes of a file of images.
pub(super) const MAGIC: &[u8] = NANOSCOPE_IMAGES;

/// Longest header read; a header has some hundred lines of text.
const LONGEST_HEADER: usize = 1 << 24;

/// Name of the format in messages.
const FORMAT: &str = "Nanoscope";

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
    let is_height = |image: &&Section| height_step(image, &sections).is_some();
    let mut heights = images.iter().copied().filter(is_height);
    let Some(image) = heights.next() else {
        return Err(FileError::NotALength {
            what: "heights",
            unit: images[0].find("@2:image data").unwrap_or("").to_owned(),
        });
    };
    let number = |key: &str| {
        let value = image.find(key).and_then(|value| value.parse::<i64>().ok());
        value.ok_or_else(|| file.broken(0, format!("an image has no whole number as {key:?}")))
    };
    let shape = checked_shape(number("number of lines")?, number("samps/line")?)?;
    let [rows, columns] = shape;
    // From version 9.2 on two bytes of resolution are stored in four.
    let resolution = number("bytes/pixel")?;
    let stored = number("data length")? / (rows * columns) as i64;
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
        size: image
            .find("scan size")
            .and_then(scan_size)
            .map(Size::Metres),
        unit: Some(1.0),
        ..Matrix::new(values, shape)
    };
    let others = heights.count();
    if others > 0 {
        matrix.warnings.push(format!(
            "the file holds {} images of heights; the first, {}, is read",
            others + 1,
            // `S [ZSensor] "Height Sensor"`
            image
                .find("@2:image data")
                .and_then(|name| name.split('"').nth(1))
                .unwrap_or("without a name")
        ));
    }
    Ok(matrix)
}

/// Height of the whole range of an image's integers, m: `V [Sens. Zsens] (0.0067 V/LSB) 440 V`, of which the last number is
/// the range. `None` where that is no length.
fn height_step(image: &Section, sections: &[Section]) -> Option<f64> {
    let scale = image.find("@2:z scale")?;
    let range = volts(scale.rsplit_once(')')?.1)?;
    let step = range * sensitivity(scale, sections)?;
    step.is_finite().then_some(step)
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
