//! Interacting asperities of a height map.

use std::sync::Arc;

use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::prelude::*;
use tabor::theory::TheoryError;
use tabor::theory::icha::{Icha, MergeRule};

use super::{Results, Words};
use crate::errors;
use crate::surface::{Map, apart};
use crate::waiting::Talk;

/// A load on the asperities.
struct Load {
    /// Mean pressure over the contact modulus.
    pressure: f64,
    /// Of a law, Pa: its work of adhesion over its range.
    tension: f64,
    /// m.
    range: f64,
}

/// Contact area fraction, mean gap, m, number of contacts and mean tension of the law, Pa, of a periodic map, m, on a cell
/// of (lx, ly), m, under each of some loads: the columns of [`Load`]. NaN from the first that does not converge on, and how
/// many these are.
#[pyfunction]
pub fn icha<'py>(
    py: Python<'py>,
    heights: &Bound<'py, PyArray2<f64>>,
    size: [f64; 2],
    law: &str,
    loads: [PyReadonlyArray1<'py, f64>; 3],
) -> PyResult<Results<'py>> {
    let raise = |words: &str| errors::raise(py, "TheoryError", words);
    let words = [("law".to_owned(), law.to_owned())];
    let law = Words::read(&words).map_err(|words| raise(&words))?.law;
    let map = Map::new(py, heights, size, true)?;
    let [pressures, tensions, ranges] = loads.each_ref().map(|column| column.as_array());
    let columns = pressures.iter().zip(&tensions).zip(&ranges);
    let loads = columns.map(|((&pressure, &tension), &range)| Load {
        pressure,
        tension,
        range,
    });
    let loads: Vec<Load> = loads.collect();
    let talk = Arc::new(Talk::default());
    let heard = Arc::clone(&talk);
    let found = apart(py, &talk, move || -> Result<_, TheoryError> {
        let surface = Icha::new(map.grid, &map.heights)?;
        let mut loading = surface.loading(MergeRule::Volume);
        // Contacts that have merged do not part, so the loads rise.
        let mut order: Vec<usize> = (0..loads.len()).collect();
        order.sort_by(|&a, &b| loads[a].pressure.total_cmp(&loads[b].pressure));
        let mut results = [(); 4].map(|()| vec![f64::NAN; loads.len()]);
        for (done, &each) in order.iter().enumerate() {
            if !heard.goes_on() {
                break;
            }
            let load = &loads[each];
            let pressed = match loading.press(load.pressure) {
                Ok(pressed) => pressed,
                Err(TheoryError::NoSolution { .. } | TheoryError::NotConverged { .. }) => {
                    return Ok((results, order.len() - done));
                }
                Err(refused) => return Err(refused),
            };
            let gap = pressed.gap(&surface);
            let tension = gap.mean_outside(|gap| load.tension * law.traction(gap / load.range));
            let numbers = [
                pressed.contact_area_fraction(),
                gap.mean(),
                pressed.contacts.len() as f64,
                tension,
            ];
            for (column, number) in results.iter_mut().zip(numbers) {
                column[each] = number;
            }
        }
        Ok((results, 0))
    })?;
    let (results, not_converged) = found.map_err(|error| raise(&format!("icha: {error}")))?;
    let arrays = results.map(|values| PyArray1::from_vec(py, values));
    Ok((arrays.into(), not_converged))
}
