//! Colours of pictures.

use pyo3::prelude::*;
use tabor::output::palette;

use crate::errors;

/// The colours of a map, (red, green, blue) from 0 to 255 each, lowest value first.
#[pyfunction]
pub fn colours(py: Python<'_>, name: &str) -> PyResult<Vec<(u8, u8, u8)>> {
    let found = match name {
        "compression" => palette::compression(),
        "tension" => palette::tension(),
        "signed" => palette::signed(),
        "rising" => palette::rising(),
        other => {
            return Err(errors::failed(
                py,
                &format!("no colours are called {other}"),
            ));
        }
    };
    Ok(found
        .iter()
        .map(|&[red, green, blue]| (red, green, blue))
        .collect())
}
