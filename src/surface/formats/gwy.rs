//! Gwyddion's native files (.gwy): a tree of named and typed components, of which one image is
//! read.
//!
//! Reads the first image whose heights are lengths; masked pixels are missing.
//!
//! # Source
//! Gwyddion user guide, "Format of Gwyddion Files",
//! <https://gwyddion.net/documentation/user-guide-en/gwyfile-format.html>.

use super::bytes::{Bytes, checked_shape};
use super::length::length_unit;
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};
use crate::units::quoted;

/// First bytes of a file.
pub(super) const MAGIC: &[u8] = b"GWYP";

/// Name of the format in messages.
const FORMAT: &str = ".gwy";

/// Deepest tree accepted; images lie at a depth of 3.
const DEEPEST: usize = 32;

/// Reads the first image of heights.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let mut file = file.named(FORMAT);
    file.take(MAGIC.len(), "the magic word")?;
    let tree = object(&mut file, 0)?;
    let mut images: Vec<(u32, &Object)> = tree
        .pieces
        .iter()
        .filter_map(|(name, piece)| Some((image_number(name)?, piece.object()?)))
        .filter(|(_, object)| object.name == "GwyDataField")
        .collect();
    images.sort_by_key(|(number, _)| *number);
    let is_height = |object: &Object| object.unit("si_unit_z").and_then(length_unit).is_some();
    let heights: Vec<_> = images
        .iter()
        .filter(|(_, image)| is_height(image))
        .collect();
    let Some((number, image)) = heights.first() else {
        let Some((_, first)) = images.first() else {
            return Err(file.broken(MAGIC.len(), "it holds no image"));
        };
        return Err(FileError::NotALength {
            what: "heights",
            unit: first.unit("si_unit_z").unwrap_or_default().to_owned(),
        });
    };
    let mut matrix = image.matrix(&file)?;
    let mask = tree
        .find(&format!("/{number}/mask"))
        .and_then(Piece::object);
    if let Some(mask) = mask {
        matrix = covered(matrix, mask.matrix(&file)?, &file)?;
    }
    if heights.len() > 1 {
        let title = |number: u32| match tree.find(&format!("/{number}/data/title")) {
            Some(Piece::Text(title)) => format!("{number} ({title})"),
            _ => number.to_string(),
        };
        matrix.warnings.push(format!(
            "the file holds {} images of heights; the first, {}, is read",
            heights.len(),
            title(*number)
        ));
    }
    Ok(matrix)
}

/// The number of an image, from its name in the tree: `/0/data`.
fn image_number(name: &str) -> Option<u32> {
    name.strip_prefix('/')?.strip_suffix("/data")?.parse().ok()
}

/// Marks masked pixels as missing.
fn covered(matrix: Map, mask: Map, file: &Bytes) -> Result<Map, FileError> {
    if (mask.rows, mask.columns) != (matrix.rows, matrix.columns) {
        return Err(file.broken(MAGIC.len(), "a mask has another shape than its image"));
    }
    let (numbers, header) = matrix.split();
    Ok(header.with(numbers.covered(mask.values, mask.columns)))
}

/// An object of the tree.
struct Object {
    name: String,
    /// Offset of its name.
    place: usize,
    pieces: Vec<(String, Piece)>,
}

/// A component of an object, as far as it is needed.
enum Piece {
    Whole(i32),
    Real(f64),
    Text(String),
    /// Offset and count of doubles.
    Reals(usize, usize),
    Object(Object),
    /// A component of another type, skipped.
    Other,
}

impl Piece {
    fn object(&self) -> Option<&Object> {
        match self {
            Piece::Object(object) => Some(object),
            _ => None,
        }
    }
}

impl Object {
    fn find(&self, name: &str) -> Option<&Piece> {
        let piece = self.pieces.iter().find(|(other, _)| other == name);
        piece.map(|(_, piece)| piece)
    }

    /// The unit of an axis.
    fn unit(&self, axis: &str) -> Option<&str> {
        match self.find(axis)?.object()?.find("unitstr")? {
            Piece::Text(unit) => Some(unit),
            _ => None,
        }
    }

    /// The numbers of a `GwyDataField`.
    fn matrix(&self, file: &Bytes) -> Result<Map, FileError> {
        let broken = |what: &str| file.broken(self.place, format!("the image here has {what}"));
        let count = |name: &str| match self.find(name) {
            Some(Piece::Whole(count)) => Ok(i64::from(*count)),
            _ => Err(broken(&format!("no {name}"))),
        };
        let shape = checked_shape(count("yres")?, count("xres")?)?;
        let Some(Piece::Reals(start, length)) = self.find("data") else {
            return Err(broken("no heights"));
        };
        if *length != shape[0] * shape[1] {
            return Err(broken(&format!(
                "{length} heights for {} x {} points",
                shape[1], shape[0]
            )));
        }
        let mut heights = file.clone();
        heights.seek(*start, "an image")?;
        let values = heights.packed(shape, f64::from_le_bytes)?;
        // As in Gwyddion a side may be negative, and 0 means unknown.
        let side = |name: &str| match self.find(name) {
            Some(Piece::Real(side)) if side.is_finite() && *side != 0.0 => Some(side.abs()),
            _ => None,
        };
        let unit = self.unit("si_unit_xy").and_then(length_unit);
        let size = match (side("xreal"), side("yreal"), unit) {
            (Some(x), Some(y), Some(unit)) => Some(Size::Metres([x * unit, y * unit])),
            _ => None,
        };
        Ok(Matrix {
            size,
            unit: self.unit("si_unit_z").and_then(length_unit),
            ..Matrix::new(values, shape)
        })
    }
}

/// Reads an object: its name, the length of its components, the components.
fn object(file: &mut Bytes, depth: usize) -> Result<Object, FileError> {
    let place = file.offset();
    if depth > DEEPEST {
        return Err(file.broken(place, "its tree is too deep"));
    }
    let name = text(file, "the name of an object")?;
    let length = file.u32("the length of an object")? as usize;
    if length > file.left() {
        return Err(file.broken(
            place,
            format!(
                "the object {} has {length} bytes, but {} are left",
                quoted(&name),
                file.left()
            ),
        ));
    }
    let end = file.offset() + length;
    let mut pieces = Vec::new();
    while file.offset() < end {
        let name = text(file, "the name of a piece")?;
        pieces.push((name, piece(file, depth)?));
    }
    if file.offset() > end {
        let what = format!("the object {} runs over its end", quoted(&name));
        return Err(file.broken(place, what));
    }
    Ok(Object {
        name,
        place,
        pieces,
    })
}

/// Reads the type and the value of a component.
fn piece(file: &mut Bytes, depth: usize) -> Result<Piece, FileError> {
    let place = file.offset();
    let kind = file.u8("the type of a piece")?;
    Ok(match kind {
        b'b' | b'c' => {
            file.skip(1, "a piece")?;
            Piece::Other
        }
        b'i' => Piece::Whole(file.i32("a number")?),
        b'q' => {
            file.skip(8, "a number")?;
            Piece::Other
        }
        b'd' => Piece::Real(file.f64("a number")?),
        b's' => Piece::Text(text(file, "a text")?),
        b'o' => Piece::Object(object(file, depth + 1)?),
        b'C' | b'I' | b'Q' | b'D' => {
            let count = file.u32("the length of a list")? as usize;
            let size = match kind {
                b'C' => 1,
                b'I' => 4,
                _ => 8,
            };
            let start = file.offset();
            file.skip(count.saturating_mul(size), "a list of numbers")?;
            match kind {
                b'D' => Piece::Reals(start, count),
                _ => Piece::Other,
            }
        }
        b'S' | b'O' => {
            for _ in 0..file.u32("the length of a list")? {
                match kind {
                    b'S' => drop(text(file, "a text")?),
                    _ => drop(object(file, depth + 1)?),
                }
            }
            Piece::Other
        }
        other => {
            return Err(file.broken(
                place,
                format!("a component of the unknown type {:?}", char::from(other)),
            ));
        }
    })
}

/// A text that ends in a zero byte.
fn text(file: &mut Bytes, what: &str) -> Result<String, FileError> {
    let length = file.until_zero(what)?;
    let text = String::from_utf8_lossy(&file.take(length, what)?).into_owned();
    file.take(1, what)?;
    Ok(text)
}
