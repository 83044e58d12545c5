//! Sensofar's topographies (.plu): a header of fixed length, then layers of single-precision heights in um.
//!
//! # Source
//! Sensofar, "PLu file format", 2009.

use super::bytes::{Bytes, checked_shape};
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// Offsets in the header.
const PIXELS: usize = 404;
const KIND: usize = 428;
const LAYERS: usize = 489;
const FIRST_LAYER: usize = 500;

/// The kind of a measurement that is a topography.
const TOPOGRAPHY: u32 = 3;

/// Heights from here on are missing, um.
const MISSING: f32 = 1_000_001.0;

/// Metres in the format's unit of length.
const MICROMETRE: f64 = 1e-6;

/// Reads the first layer.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let mut file = file.named(".plu");
    file.seek(PIXELS, "the calibration")?;
    let mut pixel = [0.0; 2];
    for side in &mut pixel {
        *side = f64::from(file.f32("the calibration")?) * MICROMETRE;
    }
    if !pixel.iter().all(|side| side.is_finite() && *side > 0.0) {
        let what = format!("pixels of {} x {} m", pixel[0], pixel[1]);
        return Err(file.broken(PIXELS, what));
    }
    file.seek(KIND, "the configuration")?;
    let kind = file.u32("the kind of measurement")?;
    if kind != TOPOGRAPHY {
        return Err(file.broken(
            KIND,
            format!("a measurement of kind {kind}; 3 is a topography"),
        ));
    }
    file.seek(LAYERS, "the configuration")?;
    let layers = file.u8("the number of layers")?;
    file.seek(FIRST_LAYER, "the heights")?;
    let rows = file.u32("the number of rows")?;
    let columns = file.u32("the number of columns")?;
    let shape = checked_shape(rows.into(), columns.into())?;
    let values = file.packed(shape, |number| {
        let height = f32::from_le_bytes(number);
        if height < MISSING {
            f64::from(height)
        } else {
            f64::NAN
        }
    })?;
    let [dx, dy] = pixel;
    let mut matrix = Matrix {
        size: Some(Size::Metres([
            dx * f64::from(columns),
            dy * f64::from(rows),
        ])),
        unit: Some(MICROMETRE),
        ..Matrix::new(values, shape)
    };
    if layers > 1 {
        let what = format!("the file holds {layers} layers; the first is read");
        matrix.warnings.push(what);
    }
    Ok(matrix)
}
