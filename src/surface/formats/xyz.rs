//! Points with coordinates: three columns x, y, z that form a grid, in any order.
//!
//! Grid points that the file lacks are missing pixels. Rows of the map follow rising y.

use super::bytes::Bytes;
use super::text;
use crate::surface::MOST_POINTS;
use crate::surface::error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// Coordinates closer than this share of their range are equal: less than the spacing of any grid,
/// more than the rounding of a printed number.
const SAME: f64 = 1e-6;

/// Largest deviation from even spacing, in steps: for numbers printed with few digits.
const UNEVEN: f64 = 0.05;

/// Grid points for each point in the file; with fewer points in the file it is not a grid.
const SPARSEST: usize = 2;

/// Reads a file of points.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let (columns, remarks) = text::read_columns(&file)?;
    if columns.columns != 3 {
        return Err(FileError::NotAGrid {
            what: format!(
                "its lines have {} numbers; x, y and z are expected",
                columns.columns
            ),
        });
    }
    let map = gridded(&columns, remarks.lateral_unit);
    let map = map.map_err(|what| FileError::NotAGrid { what })?;
    file.expect_held([map.rows, map.columns])?;
    Ok(map.into())
}

/// Whether a matrix has as many columns and rows as points that form a map.
pub(super) fn may_be_grid(columns: &Matrix) -> bool {
    columns.columns == 3 && columns.rows >= 4
}

/// The map that the points form if it has at least two points a side; `None` for three ordinary
/// columns.
pub(super) fn as_grid(columns: &Matrix, lateral_unit: Option<f64>) -> Option<Matrix> {
    gridded(columns, lateral_unit)
        .ok()
        .filter(|map| map.rows > 1 && map.columns > 1)
}

/// Arranges points on a grid.
fn gridded(points: &Matrix, lateral_unit: Option<f64>) -> Result<Matrix, String> {
    let axes = ["x", "y"].iter().enumerate().map(|(axis, name)| {
        let coordinates: Vec<f64> = points
            .values
            .iter()
            .skip(axis)
            .step_by(3)
            .copied()
            .collect();
        Axis::from_coordinates(coordinates).map_err(|what| format!("{name}: {what}"))
    });
    let axes: Vec<Axis> = axes.collect::<Result<_, _>>()?;
    let (x, y) = (&axes[0], &axes[1]);
    let places = x.count.checked_mul(y.count);
    let Some(places) =
        places.filter(|places| *places <= MOST_POINTS && *places <= points.rows * SPARSEST)
    else {
        return Err(format!(
            "its {} points have {} different x and {} different y",
            points.rows, x.count, y.count
        ));
    };
    let mut values = vec![f64::NAN; places];
    let mut taken = vec![false; places];
    for (row, point) in points.values.chunks_exact(3).enumerate() {
        let place = y.index(point[1]) * x.count + x.index(point[0]);
        if std::mem::replace(&mut taken[place], true) {
            return Err(format!(
                "row {} lies at x = {}, y = {}, as a row above",
                row + 1,
                point[0],
                point[1]
            ));
        }
        values[place] = point[2];
    }
    // Pixels of a single line are taken as square.
    let steps = [x.step, y.step];
    let step = |axis: usize| {
        if steps[axis] > 0.0 {
            steps[axis]
        } else {
            steps[1 - axis]
        }
    };
    let sides = [step(0) * x.count as f64, step(1) * y.count as f64];
    let size = (sides[0] > 0.0).then(|| match lateral_unit {
        Some(unit) => Size::Metres(sides.map(|side| side * unit)),
        None => Size::LikeHeights(sides),
    });
    Ok(Matrix {
        size,
        unit: points.unit,
        ..Matrix::new(values, [y.count, x.count])
    })
}

/// Evenly spaced coordinates.
struct Axis {
    least: f64,
    /// Distance between neighbours; 0 for a single coordinate.
    step: f64,
    count: usize,
}

impl Axis {
    fn from_coordinates(mut coordinates: Vec<f64>) -> Result<Axis, String> {
        if let Some(row) = coordinates.iter().position(|value| !value.is_finite()) {
            return Err(format!("row {} has none", row + 1));
        }
        coordinates.sort_by(f64::total_cmp);
        let (Some(&least), Some(&greatest)) = (coordinates.first(), coordinates.last()) else {
            return Err("there is none".to_owned());
        };
        let same = SAME * (greatest - least);
        coordinates.dedup_by(|next, kept| *next - *kept <= same);
        let count = coordinates.len();
        if count == 1 {
            return Ok(Axis {
                least,
                step: 0.0,
                count,
            });
        }
        let step = (greatest - least) / (count - 1) as f64;
        let uneven = coordinates
            .iter()
            .enumerate()
            .find(|(index, value)| (*value - least - *index as f64 * step).abs() > UNEVEN * step);
        if let Some((index, value)) = uneven {
            return Err(format!(
                "{value} is not evenly spaced; place {} of {count} from {least} to {greatest} is {}",
                index + 1,
                least + index as f64 * step
            ));
        }
        Ok(Axis { least, step, count })
    }

    /// Index of a coordinate.
    fn index(&self, coordinate: f64) -> usize {
        if self.count == 1 {
            return 0;
        }
        let place = ((coordinate - self.least) / self.step).round();
        (place as usize).min(self.count - 1)
    }
}
