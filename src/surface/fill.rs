//! Interpolates missing pixels from their neighbours.

use std::ops::Range;

use super::detrend::Trend;
use super::file_error::FileError;
use crate::backend::{BackendError, Share};

/// Iteration limit of the membrane solve; a hole a few thousand pixels wide needs as many.
const MOST_ITERATIONS: usize = 20_000;

/// Residual, relative to that of a start from the mean, at which the solve ends.
const TOLERANCE: f64 = 1e-10;

/// Missing pixels that several processes fill at most: each solves for all of them, in 80 bytes a pixel.
const MOST_MISSING: usize = 1 << 22;

/// Replaces non-finite heights by a membrane stretched over the finite ones; returns the number
/// replaced.
///
/// `values` are the rows of a map that this process holds, row-major. Each replaced pixel is the mean of its neighbours
/// (up to 4; always 4 on a periodic map, across the edges). This is the discrete Laplace equation with pixels
/// taken as square, solved by conjugate gradients; the number of iterations grows with the diameter
/// of the largest hole. A membrane ends level at a free edge: where pixels are missing there and at most half of the map is, it is that
/// of the heights above the plane through the known ones, so that the tilt goes on to the edge. Without any finite pixel nothing is replaced, nor where a process has ended.
///
/// # Errors
/// More missing pixels than several processes fill.
pub(super) fn interpolate(
    values: &mut [f64],
    share: &Share,
    periodic: bool,
) -> Result<usize, FileError> {
    interpolate_at_most(values, share, periodic, MOST_MISSING)
}

/// The same of at most so many pixels on several processes.
fn interpolate_at_most(
    values: &mut [f64],
    share: &Share,
    periodic: bool,
    most: usize,
) -> Result<usize, FileError> {
    let here = values.iter().filter(|value| !value.is_finite()).count();
    let [columns, rows] = share.surface();
    let [count] = share.counts([here]);
    if count == 0 || count == rows * columns {
        return Ok(0);
    }
    if !share.is_whole() && count > most {
        return Err(FileError::MissingOnRanks { count, most });
    }
    // One that has ended is the caller's to see.
    Ok(fill(values, share, periodic).unwrap_or(0))
}

fn fill(values: &mut [f64], share: &Share, periodic: bool) -> Result<usize, BackendError> {
    let [columns, rows] = share.surface();
    let first = share.surface_rows().start * columns;
    let here: Vec<usize> = (0..values.len())
        .filter(|place| !values[*place].is_finite())
        .map(|place| first + place)
        .collect();
    let of_ranks = share.numbers(&[here.len() as f64], (0..share.count()).map(|_| 1))?;
    let lengths = || of_ranks.iter().map(|length| *length as usize);
    let numbers: Vec<f64> = here.iter().map(|pixel| *pixel as f64).collect();
    let missing = share.numbers(&numbers, lengths())?;
    let missing: Vec<usize> = missing.into_iter().map(|pixel| pixel as usize).collect();
    let none = missing.len();
    let known = (rows * columns - none) as f64;
    let [mean] = share.sums(values.len() / columns, |row, [sum]| {
        let line = &values[row * columns..(row + 1) * columns];
        for value in line.iter().filter(|value| value.is_finite()) {
            *sum += value / known;
        }
    });

    let is_at_edge = |pixel: &usize| {
        let neighbours = neighbours_of(*pixel, rows, columns, periodic).into_iter();
        let axes = [columns, rows].iter().filter(|count| **count > 1).count();
        neighbours.flatten().count() < 2 * axes
    };
    let plane = match known >= none as f64 && missing.iter().any(is_at_edge) {
        true => Trend::plane(values, share, mean, known),
        false => None,
    };
    let level = |pixel: usize| mean + plane.as_ref().map_or(0.0, |plane| plane.at(pixel));

    // Index of a missing pixel in the list of unknowns; `none` for a known pixel.
    let slot = |pixel: usize| missing.binary_search(&pixel).unwrap_or(none);
    // The equations: degree * unknown - sum of unknown neighbours = sum of known neighbours.
    let mut neighbours = Vec::with_capacity(none);
    let mut degrees = Vec::with_capacity(none);
    for pixel in &missing {
        let around = neighbours_of(*pixel, rows, columns, periodic);
        let mut slots = [none; 4];
        for (place, neighbour) in slots.iter_mut().zip(around.into_iter().flatten()) {
            *place = slot(neighbour);
        }
        degrees.push(around.iter().flatten().count() as f64);
        neighbours.push(slots);
    }
    let beside = rows_beside(values, share)?;
    let value = |pixel: usize| match pixel.checked_sub(first).and_then(|at| values.get(at)) {
        Some(value) => *value,
        None => beside.value(pixel, columns),
    };
    let load = |pixel: &usize| {
        let mut load = 0.0;
        let around = neighbours_of(*pixel, rows, columns, periodic);
        for neighbour in around.into_iter().flatten() {
            if slot(neighbour) == none {
                load += value(neighbour) - level(neighbour);
            }
        }
        load
    };
    let loads: Vec<f64> = here.iter().map(load).collect();
    // Every process solves for all.
    let unknown = solve_membrane(&neighbours, &degrees, share.numbers(&loads, lengths())?);
    for pixel in here {
        values[pixel - first] = level(pixel) + unknown[slot(pixel)];
    }
    Ok(none)
}

/// The rows before and after those of a process, on the ring of all rows.
struct RowsBeside {
    rows: [usize; 2],
    values: Vec<f64>,
}

impl RowsBeside {
    fn value(&self, pixel: usize, columns: usize) -> f64 {
        let row = self.rows.iter().position(|row| *row == pixel / columns);
        row.map_or(f64::NAN, |row| self.values[row * columns + pixel % columns])
    }
}

fn rows_beside(values: &[f64], share: &Share) -> Result<RowsBeside, BackendError> {
    let [columns, all] = share.surface();
    let beside = |rows: Range<usize>| [(rows.start + all - 1) % all, rows.end % all];
    let wanted = |rank: usize| match share.surface_rows_of(rank) {
        rows if rows.is_empty() => Vec::new(),
        rows => beside(rows).to_vec(),
    };
    let held = |rank: usize| share.surface_rows_of(rank);
    Ok(RowsBeside {
        rows: beside(share.surface_rows()),
        values: share.fetch(values, columns, held, wanted)?,
    })
}

/// Conjugate gradients for the membrane from a start of 0; `residual` is the right-hand side.
fn solve_membrane(neighbours: &[[usize; 4]], degrees: &[f64], mut residual: Vec<f64>) -> Vec<f64> {
    let count = degrees.len();
    let mut unknown = vec![0.0; count];
    let mut direction = residual.clone();
    let mut image = vec![0.0; count];
    let mut square = dot(&residual, &residual);
    let target = square * TOLERANCE * TOLERANCE;
    for _ in 0..MOST_ITERATIONS {
        if square <= target || !square.is_finite() {
            break;
        }
        for (index, slots) in neighbours.iter().enumerate() {
            let around: f64 = slots.iter().filter_map(|slot| direction.get(*slot)).sum();
            image[index] = degrees[index] * direction[index] - around;
        }
        let step = square / dot(&direction, &image);
        for index in 0..count {
            unknown[index] += step * direction[index];
            residual[index] -= step * image[index];
        }
        let next = dot(&residual, &residual);
        let turn = next / square;
        for (direction, residual) in direction.iter_mut().zip(&residual) {
            *direction = residual + turn * *direction;
        }
        square = next;
    }
    unknown
}

/// Scalar product.
fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

/// The neighbours of a pixel; `None` beyond a free edge.
fn neighbours_of(pixel: usize, rows: usize, columns: usize, periodic: bool) -> [Option<usize>; 4] {
    let (row, column) = (pixel / columns, pixel % columns);
    let step = |at: usize, count: usize, forward: bool| -> Option<usize> {
        let next = if forward { at + 1 } else { at + count - 1 };
        let inside = if forward { next < count } else { at > 0 };
        // On an axis of one point a pixel is not its own neighbour.
        (count > 1 && (inside || periodic)).then_some(next % count)
    };
    [
        step(column, columns, false).map(|column| row * columns + column),
        step(column, columns, true).map(|column| row * columns + column),
        step(row, rows, false).map(|row| row * columns + column),
        step(row, rows, true).map(|row| row * columns + column),
    ]
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::backend::Shape;
    use crate::backend::ranks::ThreadRanks;
    use approx::assert_relative_eq;

    fn filled(values: &mut [f64], rows: usize, columns: usize, periodic: bool) -> usize {
        let share = Share::whole(Shape::whole(columns, rows));
        interpolate(values, &share, periodic).unwrap()
    }

    #[test]
    fn a_plane_is_filled_exactly() {
        // A plane solves the Laplace equation; the hole does not touch the edges.
        let plane = |i: usize| 3.0 + 0.5 * (i % 12) as f64 - 2.0 * (i / 12) as f64;
        let mut values: Vec<f64> = (0..120).map(plane).collect();
        for row in 2..7 {
            for column in 3..9 {
                values[row * 12 + column] = f64::NAN;
            }
        }
        values[8 * 12 + 1] = f64::INFINITY;
        assert_eq!(filled(&mut values, 10, 12, false), 31);
        for (index, value) in values.iter().enumerate() {
            assert_relative_eq!(*value, plane(index), max_relative = 1e-8, epsilon = 1e-8);
        }
    }

    /// A tilt goes on to a free edge, where a level membrane would bend it, and a map that is mostly missing ends level.
    #[test]
    fn a_missing_edge_keeps_the_tilt() {
        let plane = |i: usize| 3.0 + 0.5 * (i % 12) as f64 - 2.0 * (i / 12) as f64;
        for strip in [4, 8] {
            let is_missing = |i: usize| i % 12 >= 12 - strip;
            let known = |i| if is_missing(i) { f64::NAN } else { plane(i) };
            let mut values: Vec<f64> = (0..120).map(known).collect();
            assert_eq!(filled(&mut values, 10, 12, false), 10 * strip);
            let worst = (0..120).map(|i| (values[i] - plane(i)).abs());
            let worst = worst.fold(0.0, f64::max);
            assert_eq!(worst < 1e-9, strip == 4, "{worst}");
            assert!(values.iter().all(|value| (-16.0..=9.0).contains(value)));
        }
    }

    /// Every process refuses what is too much for one of several, and fills what is not, to the bits of one alone.
    #[test]
    fn several_processes_refuse_too_many_holes() {
        let shape = Shape::whole(4, 24);
        let heights = |row: usize| (0..4).map(move |x| ((row * 4 + x) as f64).sin());
        let holed = |rows: Range<usize>| -> Vec<f64> {
            let heights = rows.flat_map(|row| heights(row).map(move |h| (row, h)));
            let holes = heights.enumerate();
            holes
                .map(|(i, (row, h))| {
                    if row % 6 == 0 && i % 4 == 1 {
                        f64::NAN
                    } else {
                        h
                    }
                })
                .collect()
        };
        let mut alone = holed(0..24);
        assert_eq!(filled(&mut alone, 24, 4, true), 4);
        std::thread::scope(|scope| {
            for rank in ThreadRanks::new(2) {
                let (alone, holed) = (&alone, &holed);
                scope.spawn(move || {
                    let share = Share::on_ranks(shape, Some(Arc::new(rank)));
                    let rows = share.surface_rows();
                    let mut values = holed(rows.clone());
                    let refused = interpolate_at_most(&mut values, &share, true, 3);
                    let named = FileError::MissingOnRanks { count: 4, most: 3 };
                    assert_eq!(refused.unwrap_err().to_string(), named.to_string());
                    assert_eq!(
                        interpolate_at_most(&mut values, &share, true, 4).unwrap(),
                        4
                    );
                    assert_eq!(values, alone[4 * rows.start..4 * rows.end]);
                });
            }
        });
    }

    #[test]
    fn a_hole_at_a_periodic_edge_has_neighbours_opposite() {
        let row = [f64::NAN, 1.0, 2.0, 7.0];
        let mut free = row;
        filled(&mut free, 1, 4, false);
        // The line through the others is 1/3 at 1 and -8/3 at 0.
        assert_relative_eq!(free[0], -2.0, max_relative = 1e-12);
        let mut periodic = row;
        filled(&mut periodic, 1, 4, true);
        assert_relative_eq!(periodic[0], 4.0, max_relative = 1e-12);
    }

    #[test]
    fn a_map_without_finite_pixels_is_unchanged() {
        let mut values = [f64::NAN; 4];
        assert_eq!(filled(&mut values, 2, 2, true), 0);
        assert_eq!(filled(&mut [1.0; 4], 2, 2, true), 0);
    }
}
