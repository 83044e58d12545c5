//! Zygo's MetroPro maps (.dat): a header, intensities, then heights as integers, all in Motorola's order.
//!
//! # Source
//! Zygo, "MetroPro reference guide" OMP-0347, "Data format".

use super::bytes::{Bytes, checked_shape};
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// First bytes of a file, of the three forms of its header.
pub(super) const MAGIC: [&[u8]; 3] = [
    b"\x88\x1b\x03\x6f",
    b"\x88\x1b\x03\x70",
    b"\x88\x1b\x03\x71",
];

/// Offsets in the header.
const HEADER_LENGTH: usize = 6;
const INTENSITY_BYTES: usize = 60;
const COLUMNS_AND_ROWS: usize = 68;
const SCALE_FACTOR: usize = 164;
const WAVELENGTH: usize = 168;
const OBLIQUITY: usize = 176;
const PIXEL: usize = 184;
const PHASE_RESOLUTION: usize = 218;
const SIGN: usize = 232;

/// Steps of a fringe for each phase resolution.
const STEPS: [f64; 3] = [4096.0, 32768.0, 131_072.0];

/// Integers from here on are missing heights.
const MISSING: i32 = 2_147_483_640;

/// Reads the heights.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let mut file = file.named("MetroPro");
    let mut real = |place: usize| -> Result<f64, FileError> {
        file.seek(place, "the header")?;
        Ok(file.big_f32("the header")?.into())
    };
    let factors = [SCALE_FACTOR, WAVELENGTH, OBLIQUITY].map(&mut real);
    let [scale, wavelength, obliquity] = factors;
    let pixel = real(PIXEL)?;
    let mut step = scale? * wavelength? * obliquity?;
    file.seek(PHASE_RESOLUTION, "the header")?;
    let resolution = file.big_i16("the phase resolution")?;
    let Some(steps) = usize::try_from(resolution)
        .ok()
        .and_then(|code| STEPS.get(code))
    else {
        let what = format!("a phase resolution of {resolution}; 0 to 2 are known");
        return Err(file.broken(PHASE_RESOLUTION, what));
    };
    step /= steps;
    file.seek(SIGN, "the header")?;
    if file.big_i16("the sign")? != 0 {
        step = -step;
    }
    file.seek(COLUMNS_AND_ROWS, "the header")?;
    let columns = file.big_u16("the number of columns")?;
    let rows = file.big_u16("the number of rows")?;
    let shape = checked_shape(rows.into(), columns.into())?;
    file.seek(HEADER_LENGTH, "the header")?;
    let header = file.big_u32("the length of the header")?;
    file.seek(INTENSITY_BYTES, "the header")?;
    let intensities = file.big_u32("the length of the intensities")?;
    file.seek(header as usize + intensities as usize, "the heights")?;
    let values = file.packed(shape, move |number| match i32::from_be_bytes(number) {
        MISSING.. => f64::NAN,
        number => step * f64::from(number),
    })?;
    // 0 where the instrument was not calibrated.
    let size = (pixel.is_finite() && pixel > 0.0)
        .then(|| Size::Metres([pixel * f64::from(columns), pixel * f64::from(rows)]));
    Ok(Matrix {
        size,
        unit: Some(1.0),
        ..Matrix::new(values, shape)
    })
}
