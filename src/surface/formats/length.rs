//! Units of length as instruments and their programs write them.

use crate::surface::file_error::FileError;
use crate::units::{Dimension, unit_factor};

/// Metres in a unit of length; `None` if the unit is not a length.
pub(super) fn length_unit(name: &str) -> Option<f64> {
    let name = name.trim();
    match name {
        "\u{c5}" | "\u{212b}" | "A" | "Angstrom" | "angstrom" => Some(1e-10),
        "cm" => Some(1e-2),
        "dm" => Some(1e-1),
        // The micro sign in old code pages, and its replacement characters.
        "\u{e6}m" | "\u{fffd}m" | "~m" | "micron" | "microns" => Some(1e-6),
        _ => unit_factor(name, Dimension::Length).ok(),
    }
}

/// Metres in the unit that a file states for `what`; `None` if it states none.
///
/// # Errors
/// A unit that is not a length.
pub(super) fn stated_unit(name: &str, what: &'static str) -> Result<Option<f64>, FileError> {
    if name.trim().is_empty() {
        return Ok(None);
    }
    match length_unit(name) {
        Some(metres) => Ok(Some(metres)),
        None => Err(FileError::NotALength {
            what,
            unit: name.trim().chars().take(40).collect(),
        }),
    }
}
