//! Alicona's height maps (.al3d): tags of 52 bytes, a comment, 32-bit floats in metres.
//!
//! # Source
//! Alicona Imaging, "AL3D format", version 1.0.

use super::bytes::{Bytes, checked_shape};
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// First bytes of a file.
pub(super) const MAGIC: &[u8] = b"AliconaImaging\0\r\n";

/// Lengths of a tag's name and value; both are followed by a line end of two bytes.
const NAME: usize = 20;
const VALUE: usize = 30;

/// Rows begin at multiples of this many bytes.
const ALIGNMENT: usize = 8;

/// Heights from here on are missing, whatever the tag says.
const MISSING: f64 = 3e15;

/// Relative difference up to which a height equals the missing value, in single precision.
const SINGLE: f64 = 1.5e-7;

/// Reads the depth image.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let mut file = file.named(".al3d");
    file.take(MAGIC.len(), "the magic word")?;
    let mut tags = Tags(Vec::new());
    for expected in ["Version", "TagCount"] {
        let place = file.offset();
        tags.take(&mut file)?;
        if tags.0.last().is_none_or(|(_, name, _)| name != expected) {
            return Err(file.broken(place, format!("the tag {expected} is missing")));
        }
    }
    let count: usize = tags.number(&file, "TagCount")?;
    for _ in 0..count {
        tags.take(&mut file)?;
    }
    let shape = checked_shape(tags.number(&file, "Rows")?, tags.number(&file, "Cols")?)?;
    let [rows, columns] = shape;
    let mut sides = [columns as f64, rows as f64];
    for (side, name) in sides.iter_mut().zip(["PixelSizeXMeter", "PixelSizeYMeter"]) {
        let length: f64 = tags.number(&file, name)?;
        if !(length.is_finite() && length > 0.0) {
            return Err(file.broken(
                tags.place(name),
                format!("{name} = {length} is not a length"),
            ));
        }
        *side *= length;
    }
    let missing: f64 = match tags.find("InvalidPixelValue") {
        Some(_) => tags.number(&file, "InvalidPixelValue")?,
        None => f64::NAN,
    };
    let start: usize = tags.number(&file, "DepthImageOffset")?;
    if start == 0 {
        return Err(file.broken(tags.place("DepthImageOffset"), "it holds no depth image"));
    }
    file.seek(start, "the depth image")?;
    let stride = (4 * columns).next_multiple_of(ALIGNMENT);
    let values = file.matrix(shape, stride, move |element| {
        let height = f64::from(f32::from_le_bytes(element));
        let is_marked = (height - missing).abs() <= SINGLE * missing.abs();
        if is_marked || height >= MISSING * (1.0 - SINGLE) {
            f64::NAN
        } else {
            height
        }
    })?;
    Ok(Matrix {
        size: Some(Size::Metres(sides)),
        unit: Some(1.0),
        ..Matrix::new(values.into(), shape)
    })
}

/// Offsets, names and values of the tags.
struct Tags(Vec<(usize, String, String)>);

impl Tags {
    /// Adds the next tag of the file.
    fn take(&mut self, file: &mut Bytes) -> Result<(), FileError> {
        let place = file.offset();
        let name = file.text(NAME, "a tag")?;
        let value = file.text(VALUE, "a tag")?;
        if file.take(2, "a tag")? != b"\r\n" {
            return Err(file.broken(place, "a tag does not end in a line end"));
        }
        self.0.push((place, name, value));
        Ok(())
    }

    fn find(&self, name: &str) -> Option<&(usize, String, String)> {
        self.0.iter().find(|(_, other, _)| other == name)
    }

    /// Offset of a tag; the end of the magic word if it is missing.
    fn place(&self, name: &str) -> usize {
        self.find(name).map_or(MAGIC.len(), |(place, ..)| *place)
    }

    /// The value of a tag as a number.
    fn number<T: std::str::FromStr>(&self, file: &Bytes, name: &str) -> Result<T, FileError> {
        let Some((place, _, value)) = self.find(name) else {
            return Err(file.broken(MAGIC.len(), format!("the tag {name} is missing")));
        };
        value
            .parse()
            .map_err(|_| file.broken(*place, format!("{name} = {value:?} is not such a number")))
    }
}
