//! Statistics of height maps.

use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use tabor::Grid;
use tabor::scene::Boundary;
use tabor::surface::Statistics;

use crate::errors;

/// Statistics of heights, m, on a cell of (lx, ly), m.
#[pyfunction]
pub fn statistics<'py>(
    py: Python<'py>,
    heights: PyReadonlyArray2<'py, f64>,
    size: [f64; 2],
    periodic: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let [rows, columns] = [heights.shape()[0], heights.shape()[1]];
    let values: Vec<f64> = heights.as_array().iter().copied().collect();
    if values.is_empty() || values.iter().any(|value| !value.is_finite()) {
        let words = "heights: must have at least one point, all of them finite";
        return Err(errors::raise(py, "SurfaceError", words));
    }
    let grid = Grid::new([columns, rows], size);
    let boundary = if periodic {
        Boundary::Periodic
    } else {
        Boundary::Free
    };
    let found = py.detach(|| Statistics::from_heights(&grid, &values, boundary));
    let moments = found.moments;
    let table = PyDict::new(py);
    table.set_item("mean", found.mean)?;
    table.set_item("lowest", found.lowest)?;
    table.set_item("highest", found.highest)?;
    table.set_item("rms_height", moments.rms_height())?;
    table.set_item("rms_slope", moments.rms_slope())?;
    table.set_item("rms_curvature", moments.rms_curvature())?;
    table.set_item("nayak_parameter", moments.nayak())?;
    table.set_item("summit_density", moments.summit_density())?;
    Ok(table)
}
