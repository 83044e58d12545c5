//! Gwyddion's simple fields (.gsf): a text header, zero bytes up to a multiple of 4, 32-bit floats.
//!
//! # Source
//! Gwyddion user guide, "Simple Field Files", <https://gwyddion.net/documentation/user-guide-en/gsf.html>.

use super::bytes::{Bytes, checked_shape};
use super::length::stated_unit;
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// First bytes of a file.
pub(super) const MAGIC: &[u8] = b"Gwyddion Simple Field 1.";

/// Longest header accepted; a header has a few lines of text.
const LONGEST_HEADER: usize = 1 << 20;

/// Reads a field.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let mut file = file.named(".gsf");
    let start = file.beginning(LONGEST_HEADER)?;
    let Some(end) = start.iter().position(|byte| *byte == 0) else {
        return Err(file.broken(start.len(), "no zero byte ends the header"));
    };
    let header = Header::parse(&start[..end]);
    let shape = checked_shape(header.count(&file, "YRes")?, header.count(&file, "XRes")?)?;
    let lateral = stated_unit(header.text("XYUnits"), "x and y")?;
    let size = match (header.side("XReal")?, header.side("YReal")?) {
        (Some(x), Some(y)) => lateral.map(|unit| Size::Metres([x * unit, y * unit])),
        _ => None,
    };
    // One to four zero bytes.
    file.seek(end + 4 - end % 4, "the field")?;
    let values = file.packed(shape, |element| f64::from(f32::from_le_bytes(element)))?;
    let mut warnings = Vec::new();
    file.warn_of_rest(&mut warnings);
    Ok(Matrix {
        size,
        unit: stated_unit(header.text("ZUnits"), "heights")?,
        warnings,
        ..Matrix::new(values, shape)
    })
}

/// The lines `name = value` of a header, each with its number from 1.
struct Header {
    lines: Vec<(usize, String, String)>,
}

impl Header {
    fn parse(bytes: &[u8]) -> Self {
        let text = String::from_utf8_lossy(bytes);
        let lines = text.lines().enumerate().filter_map(|(index, line)| {
            let (name, value) = line.split_once('=')?;
            Some((index + 1, name.trim().to_owned(), value.trim().to_owned()))
        });
        Header {
            lines: lines.collect(),
        }
    }

    fn find(&self, name: &str) -> Option<(usize, &str)> {
        let line = self.lines.iter().find(|(_, other, _)| other == name);
        line.map(|(number, _, value)| (*number, value.as_str()))
    }

    /// A text, empty if the name is absent.
    fn text(&self, name: &str) -> &str {
        self.find(name).map_or("", |(_, value)| value)
    }

    /// A count of points.
    fn count(&self, file: &Bytes, name: &str) -> Result<i64, FileError> {
        let Some((line, value)) = self.find(name) else {
            return Err(file.broken(0, format!("its header has no {name}")));
        };
        value
            .parse()
            .map_err(|_| wrong(line, name, value, "a whole number"))
    }

    /// A positive length in the lateral unit.
    fn side(&self, name: &str) -> Result<Option<f64>, FileError> {
        let Some((line, value)) = self.find(name) else {
            return Ok(None);
        };
        match value.parse::<f64>() {
            Ok(side) if side.is_finite() && side > 0.0 => Ok(Some(side)),
            _ => Err(wrong(line, name, value, "a positive number")),
        }
    }
}

fn wrong(line: usize, name: &str, value: &str, expected: &str) -> FileError {
    let value: String = value.chars().take(40).collect();
    FileError::BrokenText {
        format: ".gsf",
        line,
        what: format!("{name} = {value:?} is not {expected}"),
    }
}
