//! Preparation of a measured map: crop, profile, outliers, edges.

use std::f64::consts::FRAC_PI_2;

use super::error::FileError;
use super::fill;
use super::matrix::{Matrix, Size};
use crate::backend::Share;

/// A map is a line scan if its sides are this many times apart,
const LINE: usize = 1000;
/// or if it has two rows of at least so many points.
const LEAST_LINE: usize = 16;
/// Relative difference of steps of a profile up to which they are equal.
const EQUAL: f64 = 1e-3;
/// A window falls to zero over one part in so many of each side.
const WINDOW: usize = 8;
/// Standard deviation of a normal distribution over its median absolute deviation.
const NORMAL: f64 = 1.4826;

/// Refuses a line scan, which is no map.
pub(super) fn expect_map([columns, rows]: [usize; 2]) -> Result<(), FileError> {
    let (short, long) = (rows.min(columns), rows.max(columns));
    if long >= LINE * short || (short <= 2 && long >= LEAST_LINE) {
        return Err(FileError::LineScan { columns, rows });
    }
    Ok(())
}

/// A line of heights, or two of places and heights, as one row along x; of more lines the first.
pub(super) fn to_profile(matrix: &mut Matrix) -> Result<(), FileError> {
    let (rows, columns) = (matrix.rows, matrix.columns);
    let count = rows.max(columns);
    let line = |index: usize| -> Vec<f64> {
        let along = |at: usize| {
            if rows <= columns {
                index * columns + at
            } else {
                at * columns + index
            }
        };
        (0..count).map(|at| matrix.values[along(at)]).collect()
    };
    let lines = rows.min(columns);
    let length = match lines {
        2 => length(&line(0)),
        _ => None,
    };
    let heights = line(usize::from(length.is_some()));
    if length.is_none() && lines > 1 {
        matrix.warnings.push(format!(
            "of {lines} lines the first is the profile; a profile has one line of heights, or two of places at equal distances and heights"
        ));
    }
    matrix.size = match (length, matrix.size) {
        (Some(length), _) => Some(Size::LikeHeights([length; 2])),
        (None, Some(Size::Metres(size))) => Some(Size::Metres([size[0].max(size[1]); 2])),
        (None, size) => size,
    };
    matrix.values = heights;
    (matrix.rows, matrix.columns) = (1, count);
    Ok(())
}

/// Length of a profile at these places, if their distances are equal.
fn length(places: &[f64]) -> Option<f64> {
    let (first, last) = (places.first()?, places.last()?);
    let step = (last - first) / (places.len() as f64 - 1.0);
    let mut steps = places.windows(2).map(|pair| pair[1] - pair[0]);
    let equal = step != 0.0 && steps.all(|one| (one - step).abs() <= EQUAL * step.abs());
    equal.then(|| step.abs() * places.len() as f64)
}

/// Refuses the part of so many points along x and y from `[x, y]` on that is not within a map of so many columns and rows.
pub(super) fn check_crop(crop: [usize; 4], [columns, rows]: [usize; 2]) -> Result<(), FileError> {
    let [x, y, nx, ny] = crop;
    let ends = [x.checked_add(nx), y.checked_add(ny)];
    if ends[0].is_some_and(|end| end <= columns) && ends[1].is_some_and(|end| end <= rows) {
        return Ok(());
    }
    Err(FileError::Crop {
        crop,
        columns,
        rows,
    })
}

/// Size of that part of a map of such a size.
pub(super) fn cropped_size(crop: [usize; 4], [columns, rows]: [usize; 2], size: Size) -> Size {
    let [_, _, nx, ny] = crop;
    let part = |[width, height]: [f64; 2]| {
        [
            width * nx as f64 / columns as f64,
            height * ny as f64 / rows as f64,
        ]
    };
    match size {
        Size::Metres(size) => Size::Metres(part(size)),
        Size::LikeHeights(size) => Size::LikeHeights(part(size)),
    }
}

/// Keeps the points from `[x, y]` on, so many along x and y.
pub(super) fn crop(matrix: &mut Matrix, crop: [usize; 4]) -> Result<(), FileError> {
    let (rows, columns) = (matrix.rows, matrix.columns);
    check_crop(crop, [columns, rows])?;
    let [x, y, nx, ny] = crop;
    matrix.values.truncate((y + ny) * columns);
    matrix.values.drain(..y * columns);
    matrix.values.shrink_to_fit();
    if nx != columns {
        let rows = matrix.values.chunks_exact(columns);
        matrix.values = rows.flat_map(|row| &row[x..x + nx]).copied().collect();
    }
    let size = matrix.size;
    matrix.size = size.map(|size| cropped_size(crop, [columns, rows], size));
    (matrix.rows, matrix.columns) = (ny, nx);
    Ok(())
}

/// Interpolates points that stand out of their eight neighbours' median by more than `times` the standard deviation
/// of such differences, estimated from their median. Returns how many; none where a process has ended.
///
/// # Errors
/// More of them than several processes fill.
pub(super) fn remove_outliers(
    values: &mut [f64],
    share: &Share,
    times: f64,
    periodic: bool,
) -> Result<usize, FileError> {
    let columns = share.surface()[0];
    let Ok([before, after]) = share.surface_rows_beside(values) else {
        return Ok(0);
    };
    // The held rows between those beside them, which an edge of the map lacks.
    let around_here = [&before[..], values, &after[..]].concat();
    let differences: Vec<f64> = (before.len()..before.len() + values.len())
        .map(|index| around_here[index] - median(&mut around(&around_here, columns, index)))
        .collect();
    drop(around_here);
    let mut sizes: Vec<f64> = differences.iter().map(|one| one.abs()).collect();
    let deviation = NORMAL * median_of_all(&mut sizes, share);
    drop(sizes);
    if deviation == 0.0 {
        return Ok(0);
    }
    for (value, difference) in values.iter_mut().zip(&differences) {
        if difference.abs() > times * deviation {
            *value = f64::NAN;
        }
    }
    fill::interpolate(values, share, periodic)
}

/// The up to eight neighbours of a point.
fn around(values: &[f64], columns: usize, index: usize) -> Vec<f64> {
    let rows = values.len() / columns;
    let (row, column) = (index / columns, index % columns);
    let mut found = Vec::with_capacity(8);
    for r in row.saturating_sub(1)..=(row + 1).min(rows - 1) {
        for c in column.saturating_sub(1)..=(column + 1).min(columns - 1) {
            if (r, c) != (row, column) {
                found.push(values[r * columns + c]);
            }
        }
    }
    found
}

/// Median of sizes, of which each process has some.
fn median_of_all(sizes: &mut [f64], share: &Share) -> f64 {
    if share.is_whole() {
        return median(sizes);
    }
    let [columns, rows] = share.surface();
    let below = rows * columns / 2;
    // The bits of numbers without a sign are in their order: the last number that has no more than that many below it.
    let (mut least, mut greatest) = (0, f64::INFINITY.to_bits());
    while least < greatest {
        let middle = greatest - (greatest - least) / 2;
        let bits = sizes.iter().map(|size| size.to_bits());
        let [count] = share.counts([bits.filter(|bits| *bits < middle).count()]);
        if count <= below {
            least = middle;
        } else {
            greatest = middle - 1;
        }
    }
    f64::from_bits(least)
}

/// Median; 0 of nothing. Reorders the values.
fn median(values: &mut [f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Brings the heights of the held rows to the mean of all at the edges, over an eighth of each side.
pub(super) fn window(heights: &mut [f64], share: &Share) {
    let [columns, rows] = share.surface();
    let first = share.surface_rows().start;
    let mean = share.surface_sum_by(heights, |height| height) / (rows * columns) as f64;
    let weight = |at: usize, count: usize| {
        let wide = (count / WINDOW) as f64;
        let inside = at.min(count - 1 - at) as f64 + 0.5;
        if count == 1 || inside >= wide {
            1.0
        } else {
            (FRAC_PI_2 * inside / wide).sin().powi(2)
        }
    };
    for (index, height) in heights.iter_mut().enumerate() {
        let weight = weight(index % columns, columns) * weight(first + index / columns, rows);
        *height = mean + (*height - mean) * weight;
    }
}

/// The map and its mirror images along both sides, twice as many points along each that has more than one.
pub(super) fn mirror(heights: &[f64], rows: usize, columns: usize) -> (Vec<f64>, [usize; 2]) {
    let twice = |count: usize| if count > 1 { 2 * count } else { 1 };
    let back = |at: usize, count: usize| if at < count { at } else { 2 * count - 1 - at };
    let points = [twice(columns), twice(rows)];
    let row = |y: usize| {
        let line = &heights[back(y, rows) * columns..][..columns];
        (0..points[0]).map(move |x| line[back(x, columns)])
    };
    ((0..points[1]).flat_map(row).collect(), points)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::Shape;

    fn all(rows: usize, columns: usize) -> Share {
        Share::whole(Shape::whole(columns, rows))
    }

    #[test]
    fn a_spike_goes_and_roughness_stays() {
        let rough: Vec<f64> = (0..400).map(|i| ((i * 37) % 11) as f64).collect();
        let mut values = rough.clone();
        values[210] = 500.0;
        values[399] = -300.0;
        assert_eq!(
            remove_outliers(&mut values, &all(20, 20), 8.0, false).unwrap(),
            2
        );
        for (index, (value, before)) in values.iter().zip(&rough).enumerate() {
            if index == 210 || index == 399 {
                assert!((0.0..=10.0).contains(value), "{index}: {value}");
            } else {
                assert_eq!(value, before);
            }
        }
        let mut flat = vec![1.0; 9];
        flat[4] = 2.0;
        assert_eq!(
            remove_outliers(&mut flat, &all(3, 3), 5.0, false).unwrap(),
            0
        );
    }

    #[test]
    fn windowed_and_mirrored_maps_close() {
        let mut heights: Vec<f64> = (0..32 * 16).map(|i| (i % 32) as f64).collect();
        let (mirrored, points) = mirror(&heights, 16, 32);
        assert_eq!(points, [64, 32]);
        assert_eq!(&mirrored[..32], &heights[..32]);
        assert_eq!(
            (mirrored[63], mirrored[31], mirrored[32]),
            (0.0, 31.0, 31.0)
        );
        assert_eq!(mirrored[31 * 64..], mirrored[..64]);
        window(&mut heights, &all(16, 32));
        let mean = 15.5;
        // Half a point from the edge, of a taper of four points.
        let least = (FRAC_PI_2 * 0.5 / 4.0).sin().powi(2);
        let row = &heights[8 * 32..9 * 32];
        assert!((row[0] - (mean - 15.5 * least)).abs() < 1e-12, "{}", row[0]);
        assert_eq!(row[10], 10.0);
        assert_eq!(
            mirror(&[1.0, 2.0], 1, 2),
            (vec![1.0, 2.0, 2.0, 1.0], [4, 1])
        );
    }

    #[test]
    fn profiles_have_one_line_or_places_too() {
        let mut lines = Matrix::new(vec![0.0, 3.0, 0.5, 4.0, 1.0, 6.0], [3, 2]);
        to_profile(&mut lines).unwrap();
        assert_eq!(
            (lines.values.as_slice(), lines.rows),
            ([3.0, 4.0, 6.0].as_slice(), 1)
        );
        assert_eq!(lines.size, Some(Size::LikeHeights([1.5; 2])));
        assert!(lines.warnings.is_empty());
        let mut uneven = Matrix::new(vec![0.0, 3.0, 0.5, 4.0, 9.0, 6.0], [3, 2]);
        to_profile(&mut uneven).unwrap();
        assert_eq!(
            (uneven.values[2], uneven.size, uneven.warnings.len()),
            (9.0, None, 1)
        );
    }
}
