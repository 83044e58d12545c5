//! What GDAL states in a TIFF image of heights: the number of missing pixels, and a scale with an offset.

use roxmltree::Document;
use tiff::tags::{PhotometricInterpretation, Tag};

use super::numbers::NumberRows;
use super::tiff::{Image, broken};
use crate::surface::file_error::FileError;
use crate::units::quoted;

/// The tag of GDAL's metadata, a text of XML.
const GDAL_METADATA: u16 = 42112;

/// The number of missing pixels that GDAL states, as the numbers of an image of so many bits are read.
pub(super) fn missing_number(
    image: &mut Image,
    bits: u8,
    warnings: &mut Vec<String>,
) -> Result<Option<f64>, FileError> {
    let Some(value) = image.find_tag(Tag::GdalNodata).map_err(broken)? else {
        return Ok(None);
    };
    let text = value.into_string().map_err(broken)?;
    let text = text.trim_matches(|c: char| c == '\0' || c.is_whitespace());
    let Ok(number) = text.parse::<f64>() else {
        warnings.push(format!(
            "the file states {} as the number of missing pixels (GDAL_NODATA), which is no number and not used",
            quoted(text)
        ));
        return Ok(None);
    };
    let white: f64 = match bits {
        8 => u8::MAX.into(),
        16 => u16::MAX.into(),
        // Programs state the least double for the least number of the image.
        32 if number.is_finite() => {
            let held = number.clamp(f32::MIN.into(), f32::MAX.into()) as f32;
            return Ok(Some(held.into()));
        }
        _ => return Ok(Some(number)),
    };
    let is_inverted = is_inverted(image)?;
    Ok(Some(
        if is_inverted { white - number } else { number } / white,
    ))
}

/// Whether 0 is white.
fn is_inverted(image: &mut Image) -> Result<bool, FileError> {
    let shades: Option<u16> = image
        .find_tag_unsigned(Tag::PhotometricInterpretation)
        .map_err(broken)?;
    Ok(shades == Some(PhotometricInterpretation::WhiteIsZero.to_u16()))
}

/// Factor and summand that make heights of the numbers of an image of so many bits, as they are read, by the scale and the offset that
/// GDAL states; `None` without either.
pub(super) fn scale_and_offset(image: &mut Image, bits: u8) -> Result<Option<[f64; 2]>, FileError> {
    let tag = Tag::Unknown(GDAL_METADATA);
    let Some(value) = image.find_tag(tag).map_err(broken)? else {
        return Ok(None);
    };
    let text = value.into_string().map_err(broken)?;
    let Ok(document) = Document::parse(text.trim_matches('\0')) else {
        return Ok(None);
    };
    let number = |role: &str| {
        let mut items = document.descendants();
        let item = items.find(|item| {
            let is_first = item.attribute("sample").is_none_or(|sample| sample == "0");
            item.attribute("role") == Some(role) && is_first
        });
        let number: f64 = item?.text()?.trim().parse().ok()?;
        number.is_finite().then_some(number)
    };
    let (scale, offset) = match (number("scale"), number("offset")) {
        (None, None) => return Ok(None),
        (scale, offset) => (scale.unwrap_or(1.0), offset.unwrap_or(0.0)),
    };
    // Shades are read from 0 to 1.
    let white: f64 = match bits {
        8 => u8::MAX.into(),
        16 => u16::MAX.into(),
        _ => return Ok(Some([scale, offset])),
    };
    Ok(Some(if is_inverted(image)? {
        [-white * scale, white * scale + offset]
    } else {
        [white * scale, offset]
    }))
}

/// Numbers times a factor, and a summand.
pub(super) struct Scaled {
    pub(super) rows: Box<dyn NumberRows>,
    pub(super) line: [f64; 2],
}

impl NumberRows for Scaled {
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        self.rows.next(values)?;
        let [factor, summand] = self.line;
        for value in values {
            *value = factor * *value + summand;
        }
        Ok(())
    }
}

/// Numbers of which one value is missing.
pub(super) struct WithoutMissing {
    pub(super) rows: Box<dyn NumberRows>,
    pub(super) missing: f64,
}

impl NumberRows for WithoutMissing {
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        self.rows.next(values)?;
        for value in values {
            if *value == self.missing {
                *value = f64::NAN;
            }
        }
        Ok(())
    }
}
