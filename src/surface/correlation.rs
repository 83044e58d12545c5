//! The radially averaged autocorrelation of heights and its correlation length.

use num_complex::Complex;

use super::fourier;
use crate::grid::{Grid, signed_index};
use crate::scene::Boundary;

/// The correlation length is the distance at which the autocorrelation has fallen to 1/e.
const ONE_OVER_E: f64 = 0.367_879_441_171_442_33;

/// Correlation length, m: the shortest distance at which the autocorrelation of the heights about
/// their mean, averaged over directions in rings one pixel wide, falls to 1/e of the mean square
/// height.
///
/// On a free grid the map is padded with zeros, so that only pairs of points on the map count, and
/// each distance is divided by its number of pairs. `None` if the autocorrelation does not fall to
/// 1/e within half the shorter side, and for a flat map. Costs one transform each way, of 9/4 as
/// many points on a free grid.
pub fn correlation_length(grid: &Grid, heights: &[f64], boundary: Boundary) -> Option<f64> {
    length_of(&autocorrelation(grid, heights, boundary))
}

/// Correlation length of the rings of an autocorrelation, m.
pub(crate) fn length_of(rings: &[(f64, f64)]) -> Option<f64> {
    let (_, whole) = *rings.first()?;
    if !(whole.is_finite() && whole > 0.0) {
        return None;
    }
    let target = ONE_OVER_E * whole;
    let pair = rings.windows(2).find(|pair| pair[1].1 <= target)?;
    let [(near, before), (far, after)] = [pair[0], pair[1]];
    Some(near + (far - near) * (before - target) / (before - after))
}

/// Mean distance (m) and mean product of heights (m^2) of rings a pixel wide, from distance 0 to half
/// the shorter side.
pub(crate) fn autocorrelation(grid: &Grid, heights: &[f64], boundary: Boundary) -> Vec<(f64, f64)> {
    let mean = heights.iter().sum::<f64>() / grid.len() as f64;
    // With half a side of zeros no pair of points within half a side wraps round.
    let padded = match boundary {
        Boundary::Periodic => *grid,
        Boundary::Free => {
            let points = [grid.nx, grid.ny].map(|points| points + points.div_ceil(2));
            let size = [grid.dx() * points[0] as f64, grid.dy() * points[1] as f64];
            Grid::new(points, size)
        }
    };
    let mut field = vec![0.0; padded.len()];
    for (row, heights) in field.chunks_mut(padded.nx).zip(heights.chunks(grid.nx)) {
        for (value, height) in row.iter_mut().zip(heights) {
            *value = height - mean;
        }
    }
    let mut spectrum = fourier::analyse(&padded, &field);
    for coefficient in &mut spectrum {
        *coefficient = Complex::new(coefficient.norm_sqr(), 0.0);
    }
    let products = fourier::synthesise(&padded, spectrum);

    let shorter = |lengths: [f64; 2]| {
        let [x, y] = grid.varying(lengths);
        x.min(y)
    };
    let pixel = shorter([grid.dx(), grid.dy()]);
    let farthest = 0.5 * shorter([grid.lx, grid.ly]);
    let mut rings = vec![(0.0, 0.0, 0_usize); (farthest / pixel) as usize + 1];
    for (index, product) in products.iter().enumerate() {
        let lags = [
            signed_index(index % padded.nx, padded.nx).unsigned_abs() as usize,
            signed_index(index / padded.nx, padded.ny).unsigned_abs() as usize,
        ];
        let distance = (lags[0] as f64 * grid.dx()).hypot(lags[1] as f64 * grid.dy());
        let ring = (distance / pixel).round() as usize;
        if ring >= rings.len() || lags[0] >= grid.nx || lags[1] >= grid.ny {
            continue;
        }
        // Share of the points that have a partner at this distance; the transform averages over all
        // points.
        let share = match boundary {
            Boundary::Periodic => 1.0,
            Boundary::Free => {
                ((grid.nx - lags[0]) * (grid.ny - lags[1])) as f64 / padded.len() as f64
            }
        };
        rings[ring].0 += distance;
        rings[ring].1 += product / share;
        rings[ring].2 += 1;
    }
    let filled = rings.into_iter().filter(|(.., count)| *count > 0);
    filled
        .map(|(distance, product, count)| (distance / count as f64, product / count as f64))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::PI;

    fn egg_box(points: usize, waves: f64) -> (Grid, Vec<f64>) {
        let grid = Grid::new([points, points], [1.0, 1.0]);
        let wave = |i: usize| (2.0 * PI * waves * i as f64 / points as f64).cos();
        let heights = (0..grid.len())
            .map(|i| 3.0 + wave(i % points) + wave(i / points))
            .collect();
        (grid, heights)
    }

    /// However far it goes across, where nothing varies.
    #[test]
    fn a_profile_has_its_length_along_it() {
        let wave = |i: usize| (2.0 * PI * 4.0 * i as f64 / 64.0).cos();
        let heights: Vec<f64> = (0..64).map(wave).collect();
        let length = |points, size| {
            correlation_length(&Grid::new(points, size), &heights, Boundary::Free)
                .expect("a length")
        };
        let expected = length([64, 1], [1.0, 1.0]);
        for across in [1e-3, 30.0] {
            assert_relative_eq!(
                length([64, 1], [1.0, across]),
                expected,
                max_relative = 1e-12
            );
            assert_relative_eq!(
                length([1, 64], [across, 1.0]),
                expected,
                max_relative = 1e-12
            );
        }
    }

    #[test]
    fn the_length_of_waves_is_that_of_a_bessel_function() {
        // <h h'> of cos x + cos y averaged over directions is J0(q r), which falls to 1/e at
        // q r = 1.74991 (bisection of its power series). Rings of a pixel, 1/64 of the wave: 2 %.
        let (grid, heights) = egg_box(256, 4.0);
        let expected = 1.749_91 / (2.0 * PI * 4.0);
        let found = correlation_length(&grid, &heights, Boundary::Periodic);
        assert_relative_eq!(found.unwrap(), expected, max_relative = 0.02);
        // The same waves cut at a phase where they do not close; fewer pairs: 5 %.
        let (grid, heights) = egg_box(256, 7.3);
        let expected = 1.749_91 / (2.0 * PI * 7.3);
        let found = correlation_length(&grid, &heights, Boundary::Free);
        assert_relative_eq!(found.unwrap(), expected, max_relative = 0.05);
    }

    #[test]
    fn pairs_on_a_free_map_are_counted_one_by_one() {
        let grid = Grid::new([5, 4], [5.0, 4.0]);
        let heights: Vec<f64> = (0..20).map(|i| f64::from((i * 7) % 11)).collect();
        let mean = heights.iter().sum::<f64>() / 20.0;
        let rings = autocorrelation(&grid, &heights, Boundary::Free);
        // Ring 1 holds the lags (+-1, 0), (0, +-1) and (+-1, +-1) (distance 1.41, nearest ring 1).
        let mut total = 0.0;
        for (dx, dy) in [
            (1, 0),
            (-1, 0),
            (0, 1),
            (0, -1),
            (1, 1),
            (1, -1),
            (-1, 1),
            (-1, -1),
        ] {
            let (mut sum, mut pairs) = (0.0, 0.0);
            for iy in 0..4_i32 {
                for ix in 0..5_i32 {
                    let (jx, jy) = (ix + dx, iy + dy);
                    if (0..5).contains(&jx) && (0..4).contains(&jy) {
                        let height = |x: i32, y: i32| heights[(y * 5 + x) as usize] - mean;
                        sum += height(ix, iy) * height(jx, jy);
                        pairs += 1.0;
                    }
                }
            }
            total += sum / pairs / 8.0;
        }
        assert_relative_eq!(rings[1].1, total, max_relative = 1e-12);
        assert_eq!(correlation_length(&grid, &[1.0; 20], Boundary::Free), None);
    }
}
