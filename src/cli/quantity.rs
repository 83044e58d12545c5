//! Quantities of a call.

use crate::units::{Dimension, RANGE_WORDS, in_range, parse_quantity};

/// A number in SI, or text with its unit.
pub(super) fn quantity(text: &str, dimension: Dimension) -> Result<f64, String> {
    let value = match text.trim().parse() {
        Ok(value) => value,
        Err(_) => parse_quantity(text, dimension).map_err(|error| error.to_string())?,
    };
    if in_range(value) {
        Ok(value)
    } else {
        Err(format!("must be {RANGE_WORDS}; give {dimension}"))
    }
}

/// A quantity above zero.
pub(super) fn positive(text: &str, dimension: Dimension) -> Result<f64, String> {
    let value = quantity(text, dimension)?;
    if value > 0.0 {
        Ok(value)
    } else {
        Err(format!("must be greater than zero; give {dimension}"))
    }
}
