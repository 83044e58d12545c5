//! Statistics of height maps.

use std::ops::RangeInclusive;
use std::sync::Arc;

use numpy::{PyArray1, PyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use tabor::backend::cpu::with_threads;
use tabor::scene::Boundary;
use tabor::surface::correlation::correlation_length;
use tabor::surface::fit::fit as fit_band;
use tabor::surface::roughness::{HeightParameters, scale_dependence};
use tabor::surface::statistics::radial_spectrum;
use tabor::surface::{PartError, Statistics};
use tabor::{Grid, SharedValues};

use crate::arrays::shared;
use crate::errors;
use crate::waiting::{Talk, wait};

/// Lengths with which one can compute, m, as in scenes.
const LENGTHS: RangeInclusive<f64> = 1e-30..=1e30;

/// Heights, m, and where they lie.
pub struct Map {
    pub grid: Grid,
    pub heights: SharedValues,
    boundary: Boundary,
}

impl Map {
    pub fn new(
        py: Python<'_>,
        heights: &Bound<'_, PyArray2<f64>>,
        size: [f64; 2],
        is_periodic: bool,
    ) -> PyResult<Self> {
        let [rows, columns] = [heights.shape()[0], heights.shape()[1]];
        let values = shared(heights)?;
        if values.is_empty() || values.iter().any(|value| !value.is_finite()) {
            let words = "heights: must have at least one point, all of them finite";
            return Err(errors::raise(py, "SurfaceError", words));
        }
        let largest = values.iter().fold(0.0, |most: f64, at| most.max(at.abs()));
        if largest != 0.0 && !LENGTHS.contains(&largest) {
            let words = format!("heights: {}", PartError::ArrayExtreme { largest });
            return Err(errors::raise(py, "SurfaceError", &words));
        }
        if size.iter().any(|side| !LENGTHS.contains(side)) {
            let words = "size: must be more than zero, and between 1e-30 and 1e30 m";
            return Err(errors::raise(py, "SurfaceError", words));
        }
        Ok(Map {
            grid: Grid::new([columns, rows], size),
            heights: values,
            boundary: if is_periodic {
                Boundary::Periodic
            } else {
                Boundary::Free
            },
        })
    }
}

/// Does `work` on another thread, with a pool of its own: the pool that all share is without threads in a fork of this process.
pub fn apart<R: Send + 'static>(
    py: Python<'_>,
    talk: &Arc<Talk>,
    work: impl FnOnce() -> R + Send + 'static,
) -> PyResult<R> {
    wait(py, talk, None, move || with_threads(None, work))?
        .map_err(|error| errors::raise(py, "DeviceError", &error.to_string()))
}

/// The same for what takes no word while it works.
fn detached<R: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> R + Send + 'static,
) -> PyResult<R> {
    apart(py, &Arc::default(), work)
}

/// Statistics of heights, m, on a cell of (lx, ly), m; None for what a flat map does not have.
#[pyfunction]
pub fn statistics<'py>(
    py: Python<'py>,
    heights: &Bound<'py, PyArray2<f64>>,
    size: [f64; 2],
    is_periodic: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let map = Map::new(py, heights, size, is_periodic)?;
    let grid = map.grid;
    let (found, shape, length) = detached(py, move || {
        (
            Statistics::from_heights(&map.grid, &map.heights, map.boundary),
            HeightParameters::new(&map.heights),
            correlation_length(&map.grid, &map.heights, map.boundary),
        )
    })?;
    let moments = found.moments;
    let along = found.along_a_profile(&grid);
    let table = PyDict::new(py);
    table.set_item("mean", found.mean)?;
    table.set_item("lowest", found.lowest)?;
    table.set_item("highest", found.highest)?;
    table.set_item("rms_height", moments.rms_height())?;
    table.set_item("mean_deviation", shape.mean_deviation)?;
    table.set_item("skewness", shape.skewness)?;
    table.set_item("kurtosis", shape.kurtosis)?;
    table.set_item("rms_slope", moments.rms_slope())?;
    table.set_item("rms_curvature", moments.rms_curvature())?;
    table.set_item("correlation_length", length)?;
    table.set_item("nayak_parameter", along.nayak())?;
    table.set_item("summit_density", along.summit_density())?;
    table.set_item("mean_summit_height", along.mean_summit_height())?;
    table.set_item("mean_summit_radius", along.mean_summit_radius())?;
    Ok(table)
}

/// Columns of a table.
type Columns<'py, const N: usize> = [Bound<'py, PyArray1<f64>>; N];

/// Wave number, 1/m, and power spectral density, m^4, of each ring of the spectrum, and its number of modes.
#[pyfunction]
pub fn spectrum<'py>(
    py: Python<'py>,
    heights: &Bound<'py, PyArray2<f64>>,
    size: [f64; 2],
    is_periodic: bool,
) -> PyResult<Columns<'py, 3>> {
    let map = Map::new(py, heights, size, is_periodic)?;
    let rings = detached(py, move || {
        radial_spectrum(&map.grid, &map.heights, map.boundary)
    })?;
    let column = |of: fn(&tabor::surface::statistics::SpectrumRing) -> f64| {
        PyArray1::from_vec(py, rings.iter().map(of).collect())
    };
    Ok([
        column(|ring| ring.wavenumber),
        column(|ring| ring.density),
        column(|ring| ring.modes as f64),
    ])
}

/// Distance, m, slope and curvature, 1/m, over distances of 1, 2, 4 ... points along x.
#[pyfunction]
pub fn scales<'py>(
    py: Python<'py>,
    heights: &Bound<'py, PyArray2<f64>>,
    size: [f64; 2],
    is_periodic: bool,
) -> PyResult<Columns<'py, 3>> {
    let map = Map::new(py, heights, size, is_periodic)?;
    let found = detached(py, move || {
        scale_dependence(&map.grid, &map.heights, map.boundary)
    })?;
    let column = |of: fn(&tabor::surface::roughness::ScaleDependence) -> f64| {
        PyArray1::from_vec(py, found.iter().map(of).collect())
    };
    Ok([
        column(|each| each.distance),
        column(|each| each.slope),
        column(|each| each.curvature.unwrap_or(f64::NAN)),
    ])
}

/// The self-affine spectrum like that of heights: Hurst exponent, rms height, m, wavelengths, m, and whether a roll-off and
/// a cut-off were seen.
#[pyfunction]
pub fn self_affine_like<'py>(
    py: Python<'py>,
    heights: &Bound<'py, PyArray2<f64>>,
    size: [f64; 2],
    is_periodic: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let map = Map::new(py, heights, size, is_periodic)?;
    let (fitted, statistics) = detached(py, move || {
        (
            fit_band(&map.grid, &map.heights, map.boundary),
            Statistics::from_heights(&map.grid, &map.heights, map.boundary),
        )
    })?;
    let fitted =
        fitted.map_err(|error| errors::raise(py, "SurfaceError", &format!("heights: {error}")))?;
    let spectrum = &fitted.spectrum;
    let wavelength = |wavenumber: f64| 2.0 * std::f64::consts::PI / wavenumber;
    let found = PyDict::new(py);
    found.set_item("hurst", spectrum.hurst)?;
    // The heights' own: that of the fit follows the rings only on average.
    found.set_item("rms_height", statistics.moments.rms_height())?;
    found.set_item("longest", wavelength(spectrum.long))?;
    found.set_item("rolloff", wavelength(spectrum.rolloff))?;
    found.set_item("shortest", wavelength(spectrum.short))?;
    found.set_item("rolloff_seen", fitted.rolloff_seen)?;
    found.set_item("cutoff_seen", fitted.cutoff_seen)?;
    Ok(found)
}
