//! Points with coordinates: three columns x, y, z that form a grid, in any order.
//!
//! Grid points that the file lacks are missing pixels. Rows of the map follow rising y.

use std::collections::HashMap;

use super::bytes::{Bytes, Opening};
use super::numbers::Numbers;
use super::text::{self, Text};
use super::unordered::Unordered;
use crate::surface::MOST_POINTS;
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// Coordinates closer than this share of their range are equal: less than the spacing of any grid,
/// more than the rounding of a printed number.
const SAME: f64 = 1e-6;

/// Largest deviation from even spacing, in steps: for numbers printed with few digits.
pub(in crate::surface) const UNEVEN: f64 = 0.05;

/// Rows from which a text of three or four columns is rather points than a map so narrow.
const NARROW: usize = 16;

/// Grid points for each point in the file; with fewer points in the file it is not a grid.
const SPARSEST: usize = 2;

/// Why points form no map.
pub(super) enum NoGrid {
    /// They lie otherwise.
    Otherwise(String),
    /// They lie on a grid, but one comes twice.
    Twice(String),
    /// They cannot be read, or not be sorted.
    Unread(FileError),
}

impl From<FileError> for NoGrid {
    fn from(error: FileError) -> Self {
        NoGrid::Unread(error)
    }
}

/// Reads a file of points.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let opening = file.opening();
    let (text, numbers) = text::open(file)?;
    let map = match numbers.columns {
        3 => gridded(&text, &numbers, opening),
        columns => Err(NoGrid::Otherwise(format!(
            "its lines have {columns} numbers; x, y and z are expected"
        ))),
    };
    map.map_err(|error| match error {
        NoGrid::Otherwise(what) | NoGrid::Twice(what) => FileError::NotAGrid { what },
        NoGrid::Unread(error) => error,
    })
}

/// What the lines of a text are if they may be points.
pub(super) enum Points {
    /// Points on a grid with at least two a side, or on one line if the heads of their columns name x and y.
    Grid(Map),
    /// Numbers of a map that is so narrow that they may be points; a warning says so.
    Likely(String),
    /// Other numbers.
    Unlikely,
}

/// The map that the lines of a text form if they are points.
///
/// # Errors
/// The points cannot be read, or not be sorted; points by the names of their columns, or but for one that comes twice, that form no grid.
pub(super) fn as_grid(
    text: &Text,
    numbers: &Matrix,
    opening: Opening,
) -> Result<Points, FileError> {
    let (rows, columns) = (numbers.rows, numbers.columns);
    let are_named = text.remarks().named_points(columns).is_some();
    if !matches!(columns, 3 | 4) || rows < 4 {
        return Ok(Points::Unlikely);
    }
    let found = match columns {
        3 => gridded(text, numbers, opening),
        _ => Err(NoGrid::Otherwise(four_columns())),
    };
    let (what, are_points) = match found {
        // Points on one line are a line scan, for a profile; without names a map may have an even column and an equal one.
        Ok(map) if are_named || (map.rows > 1 && map.columns > 1) => return Ok(Points::Grid(map)),
        Ok(_) => return Ok(Points::Unlikely),
        Err(NoGrid::Unread(error)) => return Err(error),
        Err(NoGrid::Twice(what)) => (what, rows >= NARROW),
        Err(NoGrid::Otherwise(what)) => (what, false),
    };
    if are_points || are_named {
        return Err(FileError::NotAGrid { what });
    }
    Ok(match rows >= NARROW {
        true => Points::Likely(format!(
            "its lines of {columns} numbers are taken as a map of {columns} x {rows} points (x, y); if they are points x y z, they form no grid: {what}"
        )),
        false => Points::Unlikely,
    })
}

/// What is wrong with points of four numbers.
fn four_columns() -> String {
    "its lines have 4 numbers; x, y and z are expected".to_owned()
}

/// Arranges points on a grid; at a glance they are taken for a square.
fn gridded(text: &Text, points: &Matrix, opening: Opening) -> Result<Map, NoGrid> {
    if opening == Opening::Glance {
        let columns = points.rows.isqrt().max(1);
        let shape = [points.rows.div_ceil(columns), columns];
        return Ok(Matrix::new(Numbers::Held(Vec::new()), shape));
    }
    let [x, y] = axes(text, points)?;
    let places = x.count.checked_mul(y.count);
    let is_map = |places: usize| places <= MOST_POINTS && places <= points.rows * SPARSEST;
    if !places.is_some_and(is_map) {
        return Err(NoGrid::Otherwise(format!(
            "its {} points have {} different x and {} different y",
            points.rows, x.count, y.count
        )));
    }
    let shape = [y.count, x.count];
    let mut unordered = Unordered::new(shape, opening)?;
    text.points(points, &mut |row, [at_x, at_y, z]| {
        let place = y.index(at_y) * x.count + x.index(at_x);
        if unordered.put(place, z)? {
            return Ok(());
        }
        let what = format!("row {row} lies at x = {at_x}, y = {at_y}, as a row above");
        // By chance few heights of a narrow map are different.
        Err(
            match places.is_some_and(|places| places * SPARSEST >= points.rows) {
                true => NoGrid::Twice(what),
                false => NoGrid::Otherwise(what),
            },
        )
    })?;
    // Pixels of a single line are taken as square.
    let steps = [x.step, y.step];
    let [of_x, of_y] = [0, 1].map(|axis| if steps[axis] > 0.0 { axis } else { 1 - axis });
    let sides = [steps[of_x] * x.count as f64, steps[of_y] * y.count as f64];
    let of_places = || match text.remarks().lateral_units(3) {
        Some(units) => Size::Metres([sides[0] * units[of_x], sides[1] * units[of_y]]),
        None => Size::LikeHeights(sides),
    };
    let size = points.size.or_else(|| (sides[0] > 0.0).then(of_places));
    let leaves_units = text.remarks().leaves_units(3, true);
    let mut warnings: Vec<String> = text.remarks().other_unit().into_iter().collect();
    warnings.extend(leaves_units.then(|| text::UNITS_LEFT.to_owned()));
    Ok(Matrix {
        size,
        warnings,
        unit: text.remarks().number_unit(3, true),
        ..Matrix::new(unordered.numbers(), shape)
    })
}

/// The axes on which points lie.
fn axes(text: &Text, points: &Matrix) -> Result<[Axis; 2], NoGrid> {
    let mut ranges = [Coordinates::new(), Coordinates::new()];
    text.points(points, &mut |row, point| {
        for (range, coordinate) in ranges.iter_mut().zip(point) {
            range.include(row, coordinate);
        }
        Ok(())
    })?;
    text.points(points, &mut |_, point| {
        for (range, coordinate) in ranges.iter_mut().zip(point) {
            range.take(coordinate);
        }
        Ok(())
    })?;
    let [x, y] = ranges;
    let named = |range: Coordinates, name: &str| {
        let axis = range.axis();
        axis.map_err(|what| NoGrid::Otherwise(format!("{name}: {what}")))
    };
    Ok([named(x, "x")?, named(y, "y")?])
}

/// Coordinates of which many are equal but for rounding, so that few are kept.
struct Coordinates {
    least: f64,
    greatest: f64,
    /// The first row without one.
    missing: Option<usize>,
    /// The least and the greatest of those in each part of the range that is as wide as equal ones are apart.
    parts: HashMap<u64, [f64; 2]>,
}

impl Coordinates {
    fn new() -> Self {
        Coordinates {
            least: f64::INFINITY,
            greatest: f64::NEG_INFINITY,
            missing: None,
            parts: HashMap::new(),
        }
    }

    /// Extends the range.
    fn include(&mut self, row: usize, coordinate: f64) {
        if coordinate.is_finite() {
            self.least = self.least.min(coordinate);
            self.greatest = self.greatest.max(coordinate);
        } else if self.missing.is_none() {
            self.missing = Some(row);
        }
    }

    /// Difference up to which coordinates are equal.
    fn same(&self) -> f64 {
        SAME * (self.greatest - self.least)
    }

    /// Keeps a coordinate, once the range is known.
    fn take(&mut self, coordinate: f64) {
        let part = ((coordinate - self.least) / self.same()) as u64;
        let ends = self.parts.entry(part).or_insert([coordinate; 2]);
        *ends = [ends[0].min(coordinate), ends[1].max(coordinate)];
    }

    /// Their axis, if they are evenly spaced.
    fn axis(self) -> Result<Axis, String> {
        if let Some(row) = self.missing {
            return Err(format!("row {row} has none"));
        }
        let same = self.same();
        let mut kept: Vec<f64> = self.parts.into_values().flatten().collect();
        kept.sort_by(f64::total_cmp);
        kept.dedup_by(|next, kept| *next - *kept <= same);
        Axis::from_coordinates(&kept)
    }
}

/// Evenly spaced coordinates.
struct Axis {
    least: f64,
    /// Distance between neighbours; 0 for a single coordinate.
    step: f64,
    count: usize,
}

impl Axis {
    /// The axis of rising coordinates.
    fn from_coordinates(coordinates: &[f64]) -> Result<Axis, String> {
        let (Some(&least), Some(&greatest)) = (coordinates.first(), coordinates.last()) else {
            return Err("there is none".to_owned());
        };
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
