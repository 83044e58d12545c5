//! Preparation of a measured map: crop and edges.

use std::f64::consts::FRAC_PI_2;

use super::file_error::FileError;
use super::matrix::{Matrix, Size};
use crate::backend::{BackendError, Share};

/// A map is a line scan if its sides are this many times apart,
const LINE: usize = 1000;
/// or if it has two rows of at least so many points.
const LEAST_LINE: usize = 16;
/// A window falls to zero over one part in so many of each side.
const WINDOW: usize = 8;

/// Refuses a line scan, which is no map.
pub(super) fn expect_map([columns, rows]: [usize; 2]) -> Result<(), FileError> {
    let (short, long) = (rows.min(columns), rows.max(columns));
    if long >= LINE * short || (short <= 2 && long >= LEAST_LINE) {
        return Err(FileError::LineScan { columns, rows });
    }
    Ok(())
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

/// Brings the heights of the held rows to the mean of all at the edges, over an eighth of each side.
pub(super) fn window(heights: &mut [f64], share: &Share) {
    let [columns, rows] = share.surface();
    let first = share.surface_rows().start;
    let mean = share.surface_sum_by(heights, |height| height) / (rows * columns) as f64;
    let weight = |at: usize, count: usize| {
        let wide = (count / WINDOW).max(1) as f64;
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

/// Twice as many points along each side that has more than one.
pub(super) fn mirrored(points: [usize; 2]) -> [usize; 2] {
    points.map(|count| if count > 1 { 2 * count } else { 1 })
}

/// The map and its mirror images along both sides on [`mirrored`] points: the rows of these that this process holds, from its rows
/// of the map.
///
/// # Errors
/// A rank has ended.
pub(super) fn mirror(heights: &[f64], from: &Share, to: &Share) -> Result<Vec<f64>, BackendError> {
    let [columns, rows] = from.surface();
    let is_doubled = to.surface()[0] > columns;
    let back = |row: usize| row.min(2 * rows - 1 - row);
    let held = |rank: usize| from.surface_rows_of(rank);
    let wanted = |rank: usize| to.surface_rows_of(rank).map(back).collect();
    let mut found = Vec::with_capacity(to.surface_len());
    from.fetch_each(heights, columns, held, wanted, |_, line: &[f64]| {
        found.extend_from_slice(line);
        if is_doubled {
            found.extend(line.iter().rev());
        }
    })?;
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::Shape;

    fn all(rows: usize, columns: usize) -> Share {
        Share::whole(Shape::whole(columns, rows))
    }

    #[test]
    fn windowed_and_mirrored_maps_close() {
        let mut heights: Vec<f64> = (0..32 * 16).map(|i| (i % 32) as f64).collect();
        let mirror = |heights: &[f64], [columns, rows]: [usize; 2]| {
            let to = mirrored([columns, rows]);
            let found = mirror(heights, &all(rows, columns), &all(to[1], to[0]));
            (found.unwrap(), to)
        };
        let (mirrored, points) = mirror(&heights, [32, 16]);
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
            mirror(&[1.0, 2.0], [2, 1]),
            (vec![1.0, 2.0, 2.0, 1.0], [4, 1])
        );
    }
}
