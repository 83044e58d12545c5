//! Digital Surf's uncompressed surfaces (.sur), as MountainsMap and many profilers write them.
//!
//! A header of 512 bytes, a comment, a private zone, then 16- or 32-bit integers, row by row.
//!
//! # Source
//! Digital Surf, "SURF file format", version 1; ISO 25178-71 names it among the formats in use.

use super::bytes::{Bytes, checked_shape};
use super::length::stated_unit;
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// First bytes of a file, and of one whose heights are compressed.
pub(super) const MAGIC: &[u8] = b"DIGITAL SURF";
pub(super) const COMPRESSED: &[u8] = b"DSCOMPRESSED";

/// Name of the format in messages.
const FORMAT: &str = ".sur";

/// Length of the header.
const HEADER: usize = 512;

/// Kinds of objects that are or begin with heights: profiles, surfaces, series and layers of both, surfaces with an image; 0 is not
/// known. The others are images, spectra, force curves and contours.
const HEIGHTS: [u16; 10] = [0, 1, 2, 4, 5, 7, 8, 11, 13, 16];

/// Values of the field "inverted": how rows and columns are stored.
const INVERTED_Z: u16 = 1;
const FLIPPED: u16 = 2;
const FLOPPED: u16 = 3;

/// The code of a missing point is this far below the least value.
const MISSING_BELOW: i64 = 2;

/// Reads a surface.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let mut file = file.named(FORMAT);
    if file.beginning(COMPRESSED.len())? == COMPRESSED {
        return Err(FileError::NotSupported {
            what: "compressed .sur files",
            instead: "save it without compression, or as .sdf",
        });
    }
    file.take(HEADER, "the header")?;
    file.seek(0, "the header")?;
    let header = Header::parse(&mut file)?;
    let start = HEADER + header.comment + header.private;
    file.seek(start, "the heights")?;
    let (shape, codes) = (header.shape, header.codes);
    let [rows, columns] = shape;
    let values = match header.bits {
        16 => file.matrix(shape, 2 * columns, move |element| {
            codes.height(i16::from_le_bytes(element).into())
        })?,
        _ => file.matrix(shape, 4 * columns, move |element| {
            codes.height(i32::from_le_bytes(element).into())
        })?,
    };
    let values = match codes.inversion {
        FLIPPED => values.reversed_rows(),
        FLOPPED => values.last_row_first(),
        _ => values,
    };
    let [dx, dy] = header.pixel;
    let mut matrix = Matrix {
        size: Some(Size::Metres([dx * columns as f64, dy * rows as f64])),
        unit: header.unit,
        ..Matrix::new(values.into(), shape)
    };
    if header.objects > 1 {
        matrix.warnings.push(format!(
            "the file holds {} objects; the first is read",
            header.objects
        ));
    }
    Ok(matrix)
}

/// The required entries of the header.
struct Header {
    /// Profiles or surfaces of the file.
    objects: u16,
    shape: [usize; 2],
    bits: u16,
    codes: Codes,
    /// Pixel lengths along x and y, m.
    pixel: [f64; 2],
    /// Metres per unit of the heights.
    unit: Option<f64>,
    comment: usize,
    private: usize,
}

/// What the integers say of heights.
#[derive(Clone, Copy)]
struct Codes {
    /// Code of a missing point, if there are any.
    missing: Option<i64>,
    /// Height of one step of the integers, and of their zero, in units of the heights.
    step: f64,
    offset: f64,
    inversion: u16,
}

impl Header {
    /// Field by field, in the order of the format.
    fn parse(file: &mut Bytes) -> Result<Header, FileError> {
        file.take(12, "the magic words")?;
        // 0 is that of a PC.
        if file.u16("the order of bytes")? != 0 {
            return Err(FileError::NotSupported {
                what: ".sur files with the bytes in Motorola's order",
                instead: "save it in the format of a PC",
            });
        }
        let objects = file.u16("the number of objects")?;
        file.take(2, "the version")?;
        if !HEIGHTS.contains(&file.u16("the kind of object")?) {
            return Err(FileError::NotSupported {
                what: ".sur files of images, spectra, force curves or contours",
                instead: "save a surface",
            });
        }
        file.take(30 + 30 + 2 + 2 + 2, "the names")?;
        let has_missing = file.u16("the mark for missing points")? == 1;
        file.take(2 + 4 + 4, "the resolution of the gauge")?;
        let place = file.offset();
        let bits = file.u16("the bits of a point")?;
        if bits != 16 && bits != 32 {
            return Err(file.broken(place, format!("points of {bits} bits; 16 or 32 are known")));
        }
        let least = file.i32("the least value")?;
        file.take(4, "the greatest value")?;
        let columns = file.i32("the number of columns")?;
        let rows = file.i32("the number of rows")?;
        let shape = checked_shape(rows.into(), columns.into())?;
        file.take(4, "the number of points")?;
        let place = file.offset();
        let mut steps = [0.0; 3];
        for step in &mut steps {
            *step = f64::from(file.f32("the steps along x, y and z")?);
        }
        let [dx, dy, step] = steps;
        if !([dx, dy].iter().all(|step| step.is_finite() && *step > 0.0) && step.is_finite()) {
            return Err(file.broken(
                place,
                format!("steps of {dx} and {dy} along x and y, {step} of the heights"),
            ));
        }
        file.take(3 * 16, "the names of the axes")?;
        let place = file.offset();
        let mut units = [const { String::new() }; 3];
        for unit in &mut units {
            *unit = file.text(16, "the units")?;
        }
        let mut pixel = [dx, dy];
        for (side, name) in pixel.iter_mut().zip(&units) {
            let unit = stated_unit(name, "x and y")?;
            *side *= unit.ok_or_else(|| file.broken(place, "x and y have no unit"))?;
        }
        file.take(3 * 16 + 3 * 4 + 2, "the units that are shown")?;
        let inversion = file.u16("the inversion")?;
        file.take(2 + 12 + 14 + 4 + 4 + 6, "the time of the measurement")?;
        let comment = file.u16("the length of the comment")?.into();
        let private = file.u16("the length of the private zone")?.into();
        file.take(128 + 4 + 4, "the client's zone")?;
        let offset = f64::from(file.f32("the height of zero")?);
        Ok(Header {
            objects,
            shape,
            bits,
            codes: Codes {
                missing: has_missing.then_some(i64::from(least) - MISSING_BELOW),
                step,
                offset: if offset.is_finite() { offset } else { 0.0 },
                inversion,
            },
            pixel,
            unit: stated_unit(&units[2], "heights")?,
            comment,
            private,
        })
    }
}

impl Codes {
    /// The height of an integer code; NaN if the point is missing.
    fn height(&self, value: i64) -> f64 {
        if self.missing == Some(value) {
            return f64::NAN;
        }
        let height = value as f64 * self.step + self.offset;
        match self.inversion {
            INVERTED_Z | FLIPPED | FLOPPED => -height,
            _ => height,
        }
    }
}
