//! Heights and factors that are given as an array.

use super::error::PartError;
use crate::grid::Grid;
use crate::scene::GridValues;
use crate::units::in_range;

/// The heights of an array on the grid, m.
///
/// # Errors
/// Another number of points than the grid or than the array says, and heights that are not finite or with
/// which one cannot compute.
pub(super) fn heights<'a>(array: &'a GridValues, grid: &Grid) -> Result<&'a [f64], PartError> {
    let heights = values(array, grid)?;
    if let Some(point) = heights.iter().position(|height| !height.is_finite()) {
        return Err(PartError::ArrayNotFinite {
            value: heights[point],
            row: point / grid.nx + 1,
            column: point % grid.nx + 1,
        });
    }
    let largest = heights
        .iter()
        .fold(0.0, |most: f64, height| most.max(height.abs()));
    if !in_range(largest) {
        return Err(PartError::ArrayExtreme { largest });
    }
    Ok(heights)
}

/// The values of an array on the grid.
///
/// # Errors
/// Another number of points than the grid or than the array says.
pub(super) fn values<'a>(array: &'a GridValues, grid: &Grid) -> Result<&'a [f64], PartError> {
    let points = [grid.nx, grid.ny];
    if array.points() == points && array.values().len() == grid.len() {
        Ok(array.values())
    } else {
        Err(PartError::ArrayPoints {
            found: array.values().len(),
            array: array.points(),
            points,
        })
    }
}
