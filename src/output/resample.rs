//! Resamples a field to the resolution of a picture.

use super::fields::FieldRows;
use crate::grid::Grid;

/// The rows of a field of shape `[ny, nx]` at `size` pixels, row 0 first; of them one is held at a time.
///
/// An axis with more pixels than points takes the nearest point; one with fewer takes the mean over
/// the pixel, in which each point counts by its overlap.
pub(super) fn resample(grid: &Grid, values: &mut FieldRows, size: [u32; 2]) -> Vec<f64> {
    let columns = weights(grid.nx, size[0] as usize);
    let rows = weights(grid.ny, size[1] as usize);
    let mut pixels = Vec::with_capacity(columns.len() * rows.len());
    let mut line = vec![0.0; grid.nx];
    let (mut index, mut iy) = (0, 0);
    values(&mut |some| {
        for source in some.chunks_exact(grid.nx) {
            // The last row of points of one row of pixels may be the first of the next.
            while let Some(row) = rows.get(index) {
                // If a point is several pixels high, its row exists already.
                if index > 0 && *row == rows[index - 1] {
                    pixels.extend_from_within(pixels.len() - columns.len()..);
                    index += 1;
                    continue;
                }
                let Some(&(_, weight)) = row.iter().find(|(point, _)| *point == iy) else {
                    break;
                };
                for (sum, value) in line.iter_mut().zip(source) {
                    *sum += weight * value;
                }
                if row.last().is_some_and(|(point, _)| *point > iy) {
                    break;
                }
                pixels.extend(columns.iter().map(|column| {
                    let terms = column.iter().map(|&(ix, weight)| weight * line[ix]);
                    terms.sum::<f64>()
                }));
                line.fill(0.0);
                index += 1;
            }
            iy += 1;
        }
    });
    pixels
}

/// For each of `pixels` along an axis of `points`: the points it covers and their weights, which
/// add up to 1.
fn weights(points: usize, pixels: usize) -> Vec<Vec<(usize, f64)>> {
    let ratio = points as f64 / pixels as f64;
    (0..pixels)
        .map(|pixel| {
            if pixels >= points {
                // In whole numbers, so that a whole factor gives blocks of exactly that size.
                return vec![((2 * pixel + 1) * points / (2 * pixels), 1.0)];
            }
            let (start, end) = (pixel as f64 * ratio, (pixel + 1) as f64 * ratio);
            let last = (end.ceil() as usize).min(points);
            (start.floor() as usize..last)
                .map(|point| {
                    let overlap = end.min((point + 1) as f64) - start.max(point as f64);
                    (point, overlap / ratio)
                })
                .filter(|(_, weight)| *weight > 1e-12)
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A map of one row fills as many rows of pixels as the picture is high: each is summed once.
    #[test]
    fn a_row_that_repeats_is_summed_once() {
        let grid = Grid::new([1_000_000, 1], [1.0, 1.0]);
        let values: Vec<f64> = (0..grid.len()).map(|point| (point % 7) as f64).collect();
        let time = |height: u32| {
            let clock = std::time::Instant::now();
            let pixels = resample(&grid, &mut |take| take(&values), [4, height]);
            assert_eq!(pixels.len(), 4 * height as usize);
            assert!(pixels.chunks(4).all(|row| row == &pixels[..4]));
            clock.elapsed().as_secs_f64()
        };
        // Once for each row of pixels would be 500 times as long; the machine may be busy.
        let (once, often) = (time(1).min(time(1)), time(500).min(time(500)));
        assert!(often < 50.0 * once, "{often} s, {once} s");
    }

    #[test]
    fn enlarging_repeats_points_and_shrinking_keeps_the_mean() {
        let grid = Grid::new([2, 2], [1.0, 1.0]);
        let values = [1.0, 2.0, 3.0, 4.0];
        assert_eq!(
            resample(&grid, &mut |take| values.chunks(2).for_each(take), [4, 2]),
            [1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0]
        );
        let grid = Grid::new([7, 5], [1.0, 1.0]);
        let values: Vec<f64> = (0..35).map(|point| (point * point) as f64).collect();
        let shrunk = resample(&grid, &mut |take| values.chunks(7).for_each(take), [3, 2]);
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        assert!((mean(&shrunk) / mean(&values) - 1.0).abs() < 1e-12);
    }
}
