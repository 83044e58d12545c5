//! Text with units to SI.

use pyo3::prelude::*;
use tabor::units::{Dimension, parse_quantity, parse_share};

use crate::errors;

/// Dimensions by the names that the package gives them.
const DIMENSIONS: &[(&str, Dimension)] = &[
    ("angle", Dimension::Angle),
    ("conductivity", Dimension::Conductivity),
    ("energy per area", Dimension::EnergyPerArea),
    ("force", Dimension::Force),
    ("force per length", Dimension::ForcePerLength),
    ("length", Dimension::Length),
    ("length per voltage", Dimension::LengthPerVoltage),
    ("molar volume", Dimension::MolarVolume),
    ("number", Dimension::Dimensionless),
    ("per area", Dimension::PerArea),
    ("per length", Dimension::PerLength),
    ("pressure", Dimension::Pressure),
    ("speed", Dimension::Speed),
    ("temperature", Dimension::Temperature),
    ("time", Dimension::Time),
];

/// The SI value of a text such as "25 um".
#[pyfunction]
pub fn quantity(py: Python<'_>, text: &str, dimension: &str, argument: &str) -> PyResult<f64> {
    let known = DIMENSIONS.iter().find(|(name, _)| *name == dimension);
    let Some((_, dimension)) = known else {
        return Err(errors::failed(
            py,
            &format!("no dimension is called {dimension}"),
        ));
    };
    parse_quantity(text, *dimension)
        .map_err(|error| errors::raise(py, "QuantityError", &format!("{argument}: {error}")))
}

/// A share from 0 to 1 of a text such as "0.1" or "10%".
#[pyfunction]
pub fn share(py: Python<'_>, text: &str, argument: &str) -> PyResult<f64> {
    parse_share(text)
        .map_err(|error| errors::raise(py, "QuantityError", &format!("{argument}: {error}")))
}
