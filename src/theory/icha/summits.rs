//! Finds the asperities of a height map: its summits and their curvatures.

use rayon::prelude::*;

use super::Asperity;
use crate::grid::Grid;
use crate::surface::fourier;
use crate::theory::error::{TheoryError, finite};
use num_complex::Complex;

/// Refinement factor along each axis of the map on which summits are sought.
const REFINEMENT: usize = 4;
/// Most points of the refined map: half a gibibyte.
const MOST_POINTS: usize = 1 << 26;
/// Waves with less than this share of the largest amplitude are rounding errors.
const ROUNDING: f64 = 1e-13;

/// Summits of `heights` (m, shape `[ny, nx]`, periodic), with the geometric mean of their two radii
/// of curvature.
///
/// A summit is higher than its eight neighbours on a map refined four times by Fourier
/// interpolation (less if that would exceed 2^26 points), has positive Gaussian curvature by
/// central differences, and is moved by one Newton step of at most one fine pixel.
pub fn find_summits(grid: &Grid, heights: &[f64]) -> Result<Vec<Asperity>, TheoryError> {
    finite("sum of all heights", heights.iter().sum())?;
    let mut refinement = REFINEMENT;
    while refinement > 1 && grid.len().saturating_mul(refinement * refinement) > MOST_POINTS {
        refinement /= 2;
    }
    if refinement == 1 {
        return Ok(summits_of(grid, heights));
    }
    let fine = Grid::new(
        [grid.nx * refinement, grid.ny * refinement],
        [grid.lx, grid.ly],
    );
    Ok(summits_of(&fine, &interpolated(grid, heights, &fine)))
}

/// Fourier interpolation of the map on a finer grid.
fn interpolated(grid: &Grid, heights: &[f64], fine: &Grid) -> Vec<f64> {
    let (nx, ny) = (grid.nx, grid.ny);
    let coefficients = fourier::analyse(grid, heights);
    let largest = coefficients
        .iter()
        .fold(0.0_f64, |most, c| most.max(c.norm_sqr()));
    let is_rounding = |column: &[Complex<f64>]| {
        let bound = ROUNDING * ROUNDING * largest;
        column.iter().all(|c| c.norm_sqr() <= bound)
    };
    let columns: Vec<&[Complex<f64>]> = coefficients.chunks(ny).collect();
    let held = columns
        .iter()
        .rposition(|column| !is_rounding(column))
        .map_or(1, |last| last + 1);
    let mut spread = vec![Complex::default(); held * fine.ny];
    for (kx, (column, wide)) in columns.iter().zip(spread.chunks_mut(fine.ny)).enumerate() {
        // The Nyquist wave stands for both directions, which a finer grid distinguishes.
        let factor = if 2 * kx == nx { 0.5 } else { 1.0 };
        for (ky, coefficient) in column.iter().enumerate() {
            let value = coefficient * factor;
            if 2 * ky == ny {
                wide[ky] += 0.5 * value;
                wide[fine.ny - ky] += 0.5 * value;
            } else if 2 * ky < ny {
                wide[ky] = value;
            } else {
                wide[fine.ny - (ny - ky)] = value;
            }
        }
    }
    fourier::synthesise(fine, spread)
}

fn summits_of(grid: &Grid, heights: &[f64]) -> Vec<Asperity> {
    let (nx, ny) = (grid.nx, grid.ny);
    let row = |iy: usize| &heights[iy * nx..(iy + 1) * nx];
    let rows: Vec<Vec<Asperity>> = (0..ny)
        .into_par_iter()
        .map(|iy| {
            let around = [row((iy + ny - 1) % ny), row(iy), row((iy + 1) % ny)];
            (0..nx)
                .filter_map(|ix| {
                    let columns = [(ix + nx - 1) % nx, ix, (ix + 1) % nx];
                    let here = around[1][ix];
                    // Most points fail at the first neighbours.
                    if around[1][columns[0]] >= here || around[1][columns[2]] >= here {
                        return None;
                    }
                    let patch = [0, 1, 2].map(|r| columns.map(|column: usize| around[r][column]));
                    summit(&patch, grid, [ix, iy])
                })
                .collect()
        })
        .collect();
    rows.concat()
}

/// The summit at the centre of nine heights (rows along y), if there is one.
fn summit(patch: &[[f64; 3]; 3], grid: &Grid, point: [usize; 2]) -> Option<Asperity> {
    let here = patch[1][1];
    let above = (0..9)
        .filter(|&i| i != 4 && patch[i / 3][i % 3] >= here)
        .count();
    if above > 0 {
        return None;
    }
    let (dx, dy) = (grid.dx(), grid.dy());
    let slope = [
        (patch[1][2] - patch[1][0]) / (2.0 * dx),
        (patch[2][1] - patch[0][1]) / (2.0 * dy),
    ];
    let xx = (patch[1][2] - 2.0 * here + patch[1][0]) / (dx * dx);
    let yy = (patch[2][1] - 2.0 * here + patch[0][1]) / (dy * dy);
    let xy = (patch[2][2] - patch[2][0] - patch[0][2] + patch[0][0]) / (4.0 * dx * dy);
    let gaussian = xx * yy - xy * xy;
    if gaussian <= 0.0 || xx >= 0.0 {
        return None;
    }
    let step = [
        ((xy * slope[1] - yy * slope[0]) / gaussian).clamp(-dx, dx),
        ((xy * slope[0] - xx * slope[1]) / gaussian).clamp(-dy, dy),
    ];
    let rise = slope[0] * step[0]
        + slope[1] * step[1]
        + 0.5 * (xx * step[0] * step[0] + yy * step[1] * step[1])
        + xy * step[0] * step[1];
    Some(Asperity {
        position: [
            (point[0] as f64 * dx + step[0]).rem_euclid(grid.lx),
            (point[1] as f64 * dy + step[1]).rem_euclid(grid.ly),
        ],
        height: here + rise,
        radius: gaussian.sqrt().recip(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn crests_of_a_wave_off_the_points_are_found_where_they_are() {
        let grid = Grid::new([12, 10], [3.0, 2.0]);
        // Two crests, off the points; radii of curvature 1/(q^2) at amplitude 1 each way.
        let (qx, qy) = (2.0 * 2.0 * PI / 3.0, 2.0 * PI / 2.0);
        let heights: Vec<f64> = (0..grid.len())
            .map(|i| {
                let (x, y) = ((i % 12) as f64 * grid.dx(), (i / 12) as f64 * grid.dy());
                (qx * (x - 0.4)).cos() + (qy * (y - 1.33)).cos()
            })
            .collect();
        let found = find_summits(&grid, &heights).unwrap();
        assert_eq!(found.len(), 2);
        for (summit, x) in found.iter().zip([0.4, 1.9]) {
            // 24 fine points a wave: differences are off by (2 pi/24)^2/12 = 0.6 % each way.
            assert!((summit.position[0] - x).abs() < 1e-3, "{summit:?}");
            assert!((summit.position[1] - 1.33).abs() < 1e-3, "{summit:?}");
            assert!((summit.height - 2.0).abs() < 1e-4, "{summit:?}");
            assert!((summit.radius * qx * qy - 1.0).abs() < 0.01, "{summit:?}");
        }
        assert!(find_summits(&grid, &vec![f64::NAN; grid.len()]).is_err());
        assert!(
            find_summits(&grid, &vec![1.0; grid.len()])
                .unwrap()
                .is_empty()
        );
    }

    #[test]
    fn interpolation_goes_through_the_points() {
        // Values without any smoothness: the Nyquist waves must be split in two.
        let grid = Grid::new([6, 4], [1.0, 1.0]);
        let heights: Vec<f64> = (0..24).map(|i| ((i * i) as f64 * 1.7).sin()).collect();
        let fine = Grid::new([12, 8], [1.0, 1.0]);
        let finer = interpolated(&grid, &heights, &fine);
        for (i, height) in heights.iter().enumerate() {
            let found = finer[(i / 6) * 2 * 12 + (i % 6) * 2];
            assert!((found - height).abs() < 1e-13, "{i}: {found} {height}");
        }
    }
}
