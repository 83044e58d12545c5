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

/// A share from 0 to 1, as a number or in per cent.
pub(super) fn share(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.trim().strip_suffix('%') {
        Some(number) => (number.trim(), 0.01),
        None => (text.trim(), 1.0),
    };
    let share = number.parse().map(|number: f64| number * unit);
    share
        .ok()
        .filter(|share| (0.0..=1.0).contains(share))
        .ok_or_else(|| "must be a share, such as 0.1 or 10%".to_owned())
}
