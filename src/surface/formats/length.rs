//! Units of length as instruments and their programs write them.

use crate::surface::error::FileError;
use crate::units::{Dimension, unit_factor};

/// Metres in a unit of length; `None` for what is none.
pub(super) fn length_unit(name: &str) -> Option<f64> {
    let name = name.trim();
    match name {
        "\u{c5}" | "\u{212b}" | "A" | "Angstrom" | "angstrom" => Some(1e-10),
        "cm" => Some(1e-2),
        "dm" => Some(1e-1),
        // The micro sign in the code pages of old programs, and what is left of one in no code page.
        "\u{e6}m" | "\u{fffd}m" | "~m" | "micron" | "microns" => Some(1e-6),
        _ => unit_factor(name, Dimension::Length).ok(),
    }
}

/// Metres in the unit that a file gives to `what`; `None` where it gives none.
///
/// # Errors
/// A unit that is no length.
pub(super) fn said_unit(name: &str, what: &'static str) -> Result<Option<f64>, FileError> {
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
