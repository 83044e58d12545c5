//! Statistics of a height map: root mean squares, spectral moments, radial power spectrum.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use num_complex::Complex;
use rayon::prelude::*;

use super::spectrum::SpectralMoments;
use super::{across, fourier};
use crate::backend::{BackendError, Shape, Share};
use crate::grid::Grid;
use crate::scene::Boundary;

/// Rings of the radial spectrum in a decade of wave numbers.
const RINGS_A_DECADE: f64 = 20.0;

/// Statistics of a height map.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Statistics {
    /// Mean height, m.
    pub mean: f64,
    /// Lowest point, m.
    pub lowest: f64,
    /// Highest point, m.
    pub highest: f64,
    /// Moments that give rms height (about the mean), slope, curvature, Nayak parameter and summit
    /// density.
    pub moments: SpectralMoments,
}

impl Statistics {
    /// Statistics of `heights`, m, shape `[ny, nx]`.
    ///
    /// On a periodic grid slope and curvature are those of the waves (sums of `q^2 |H|^2` and `q^4
    /// |H|^2`). On a free grid the edges do not match and the waves would include a step, so slope
    /// and curvature are root mean squares of forward differences and of the five-point Laplacian,
    /// which are low for waves of a few pixels (5 % of the curvature at eight pixels).
    ///
    /// A periodic map takes one Fourier transform and twice its own memory. The grid must not be
    /// empty.
    pub fn from_heights(grid: &Grid, heights: &[f64], boundary: Boundary) -> Self {
        debug_assert!(!grid.is_empty() && heights.len() == grid.len());
        Statistics::of_share(grid, &whole(grid), heights, boundary)
    }

    /// The same of the rows that this process holds, with the others. Where one of these has ended all is NaN.
    pub(crate) fn of_share(
        grid: &Grid,
        share: &Share,
        heights: &[f64],
        boundary: Boundary,
    ) -> Self {
        let count = grid.len() as f64;
        let sum = |of_row: &(dyn Fn(&[f64]) -> f64 + Sync)| {
            sum_over_rows(grid, share, heights, |_, row| of_row(row))
        };
        let mean = sum(&|row| row.iter().sum()) / count;
        let height = sum(&|row| row.iter().map(|h| (h - mean) * (h - mean)).sum()) / count;
        let squares = match boundary {
            Boundary::Periodic => spectral_mean_squares(grid, share, heights),
            Boundary::Free => difference_mean_squares(grid, share, heights),
        };
        let [slope, curvature] = squares.unwrap_or([f64::NAN; 2]);
        Statistics {
            mean,
            lowest: share.least_of(heights),
            highest: share.greatest_of(heights),
            moments: SpectralMoments::from_isotropic([height, slope, curvature]),
        }
    }

    /// Moments of a profile through an isotropic surface of these statistics; of a line scan those of the scan itself, whose
    /// slopes all lie along it.
    pub fn along_a_profile(&self, grid: &Grid) -> SpectralMoments {
        if grid.nx > 1 && grid.ny > 1 {
            return self.moments;
        }
        SpectralMoments {
            m0: self.moments.m0,
            m2: self.moments.rms_slope().powi(2),
            m4: self.moments.rms_curvature().powi(2),
        }
    }
}

/// All rows of a grid, on this process.
pub(super) fn whole(grid: &Grid) -> Share {
    Share::whole(Shape::whole(grid.nx, grid.ny))
}

/// One ring of a radial power spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SpectrumRing {
    /// Mean wave number of its modes, 1/m.
    pub wavenumber: f64,
    /// Mean power spectral density C of its modes, m^4.
    pub density: f64,
    /// Number of modes, both half planes.
    pub modes: usize,
}

/// Power spectral density averaged over rings of constant ratio, from long waves to short.
///
/// Normalised so that `<h^2>` is the integral of C over the plane of wavevectors. The heights of a
/// free grid are multiplied by a Hann window of mean square 1; without it the mismatch of opposite
/// edges hides the short waves. Rings without modes are left out.
pub fn radial_spectrum(grid: &Grid, heights: &[f64], boundary: Boundary) -> Vec<SpectrumRing> {
    let first = first_wavenumber(grid);
    // Rounded to the nearest ring, so that the first one is centred on the first mode.
    rings(grid, heights, boundary, |wavenumber| {
        ((wavenumber / first).log10() * RINGS_A_DECADE).round() as usize
    })
}

/// As [`radial_spectrum`], over rings as wide as the first wave number, each around a multiple of it.
pub(crate) fn fine_spectrum(grid: &Grid, heights: &[f64], boundary: Boundary) -> Vec<SpectrumRing> {
    let first = first_wavenumber(grid);
    rings(grid, heights, boundary, |wavenumber| {
        (wavenumber / first).round() as usize
    })
}

/// Wave number of the longest wave of a map, 1/m.
pub(crate) fn first_wavenumber(grid: &Grid) -> f64 {
    let [x, y] = grid.varying([grid.lx, grid.ly]);
    2.0 * PI / x.max(y)
}

/// Means over the modes with the same ring number `ring_of`, by rising number.
fn rings(
    grid: &Grid,
    heights: &[f64],
    boundary: Boundary,
    ring_of: impl Fn(f64) -> usize,
) -> Vec<SpectrumRing> {
    let spectrum = match boundary {
        Boundary::Periodic => fourier::analyse(grid, heights),
        Boundary::Free => fourier::analyse(grid, &windowed(grid, heights)),
    };
    let area = grid.area() / (4.0 * PI * PI);
    // Rings are stored by number, not as a dense list: for pixels a million times longer than wide
    // the numbers far exceed the count of modes.
    let mut rings: BTreeMap<usize, SpectrumRing> = BTreeMap::new();
    for (kx, column) in spectrum.chunks(grid.ny).enumerate() {
        for (ky, coefficient) in column.iter().enumerate() {
            if kx == 0 && ky == 0 {
                continue;
            }
            let wavenumber = grid.wavenumber(kx, ky);
            let ring = rings.entry(ring_of(wavenumber)).or_insert(SpectrumRing {
                wavenumber: 0.0,
                density: 0.0,
                modes: 0,
            });
            let images = images(grid, kx);
            ring.modes += images;
            ring.wavenumber += images as f64 * wavenumber;
            ring.density += images as f64 * area * coefficient.norm_sqr();
        }
    }
    let mean = |ring: SpectrumRing| SpectrumRing {
        wavenumber: ring.wavenumber / ring.modes as f64,
        density: ring.density / ring.modes as f64,
        ..ring
    };
    rings.into_values().map(mean).collect()
}

/// Multiplicity of a stored column in the full spectrum.
fn images(grid: &Grid, kx: usize) -> usize {
    if kx == 0 || 2 * kx == grid.nx { 1 } else { 2 }
}

/// Mean square slope and Laplacian of the sum of waves.
fn spectral_mean_squares(
    grid: &Grid,
    share: &Share,
    heights: &[f64],
) -> Result<[f64; 2], BackendError> {
    let of_column = |kx: usize, column: &[Complex<f64>]| {
        let images = images(grid, kx) as f64;
        let mut sums = [0.0; 2];
        for (ky, coefficient) in column.iter().enumerate() {
            let square = grid.wavenumber(kx, ky).powi(2);
            let power = images * coefficient.norm_sqr();
            sums[0] += square * power;
            sums[1] += square * square * power;
        }
        sums
    };
    let columns: Vec<[f64; 2]> = if share.is_whole() {
        fourier::analyse_each(grid, heights, of_column)
    } else {
        across::analyse(grid, share, heights, of_column)?
    };
    Ok(columns
        .iter()
        .fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]]))
}

/// Mean square forward difference and five-point Laplacian of the points that have these
/// neighbours.
fn difference_mean_squares(
    grid: &Grid,
    share: &Share,
    heights: &[f64],
) -> Result<[f64; 2], BackendError> {
    let (nx, ny, dx, dy) = (grid.nx, grid.ny, grid.dx(), grid.dy());
    let [before, after] = share.surface_rows_beside(heights)?;
    let held = share.surface_rows();
    // A row of the grid, here or beside the held ones; empty beyond the edge.
    let line = |iy: usize| -> &[f64] {
        if iy < held.start {
            &before
        } else if iy >= held.end {
            &after
        } else {
            &heights[(iy - held.start) * nx..(iy - held.start + 1) * nx]
        }
    };
    let along_x = sum_over_rows(grid, share, heights, |_, row| {
        row.windows(2)
            .map(|pair| ((pair[1] - pair[0]) / dx).powi(2))
            .sum()
    });
    let along_y = sum_over_rows(grid, share, heights, |iy, row| {
        row.iter()
            .zip(line(iy + 1))
            .map(|(here, next)| ((next - here) / dy).powi(2))
            .sum()
    });
    // A side of one or two points has no second difference.
    let inside = |points: usize| match points {
        0..3 => 0..points,
        _ => 1..points - 1,
    };
    let (rows, columns) = (inside(ny), inside(nx));
    let laplacian = sum_over_rows(grid, share, heights, |iy, row| {
        if !rows.contains(&iy) {
            return 0.0;
        }
        let beside = (ny > 2).then(|| (line(iy - 1), line(iy + 1)));
        columns
            .clone()
            .map(|ix| {
                let along_x = match nx > 2 {
                    true => (row[ix - 1] - 2.0 * row[ix] + row[ix + 1]) / (dx * dx),
                    false => 0.0,
                };
                let along_y = beside.map_or(0.0, |(below, above)| {
                    (below[ix] - 2.0 * row[ix] + above[ix]) / (dy * dy)
                });
                (along_x + along_y).powi(2)
            })
            .sum()
    });
    // A grid one point wide has zero slope along that axis, not an undefined one.
    let mean = |sum: f64, count: usize| if count == 0 { 0.0 } else { sum / count as f64 };
    Ok([
        mean(along_x, (nx - 1) * ny) + mean(along_y, nx * (ny - 1)),
        mean(laplacian, rows.len() * columns.len()),
    ])
}

/// Heights about their mean, times a Hann window of mean square 1.
fn windowed(grid: &Grid, heights: &[f64]) -> Vec<f64> {
    let mean = heights.iter().sum::<f64>() / grid.len() as f64;
    let window = |points: usize| -> Vec<f64> {
        if points < 3 {
            // Its mean square would be another; along a side so short nothing is windowed.
            return vec![1.0; points];
        }
        (0..points)
            .map(|i| {
                let phase = 2.0 * PI * (i as f64 + 0.5) / points as f64;
                (1.0 - phase.cos()) / 1.5_f64.sqrt()
            })
            .collect()
    };
    let (along_x, along_y) = (window(grid.nx), window(grid.ny));
    let rows = heights.chunks(grid.nx).zip(&along_y);
    rows.flat_map(|(row, factor)| {
        row.iter()
            .zip(&along_x)
            .map(move |(height, window)| (height - mean) * window * factor)
    })
    .collect()
}

/// Sum over rows, added in order, so that it does not depend on threads, nor on ranks.
fn sum_over_rows(
    grid: &Grid,
    share: &Share,
    heights: &[f64],
    of_row: impl Fn(usize, &[f64]) -> f64 + Sync,
) -> f64 {
    let first = share.surface_rows().start;
    let rows: Vec<f64> = heights
        .par_chunks(grid.nx)
        .enumerate()
        .map(|(iy, row)| of_row(first + iy, row))
        .collect();
    share.sum_of_rows(&rows)
}

/// Root mean square jump between opposite edges, and between neighbours, along x and along y.
///
/// On a periodic map the two are similar. Along an axis of one point both are 0.
/// Where another process has ended they are NaN.
pub(super) fn edge_jumps(grid: &Grid, share: &Share, heights: &[f64]) -> [(f64, f64); 2] {
    let (nx, ny) = (grid.nx, grid.ny);
    let root = |sum: f64, count: usize| (sum / count.max(1) as f64).sqrt();
    let sum = |of_row: &(dyn Fn(usize, &[f64]) -> f64 + Sync)| {
        sum_over_rows(grid, share, heights, of_row)
    };
    let across_x = sum(&|_, row| (row[0] - row[nx - 1]).powi(2));
    let steps_x = sum(&|_, row| row.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum());
    let difference = |one: &[f64], other: &[f64]| -> f64 {
        one.iter().zip(other).map(|(a, b)| (a - b) * (a - b)).sum()
    };
    let own = share.surface_rows();
    let first = &heights[..nx.min(heights.len())];
    let Ok(after) = share.surface_row_after(first) else {
        return [(f64::NAN, f64::NAN); 2];
    };
    // After the last row of all comes the first one.
    let next = |iy: usize| -> &[f64] {
        let start = (iy + 1 - own.start) * nx;
        heights.get(start..start + nx).unwrap_or(&after)
    };
    let across_y = sum(&|iy, row| {
        if iy + 1 == ny {
            difference(row, next(iy))
        } else {
            0.0
        }
    });
    let steps_y = sum(&|iy, row| {
        if iy + 1 == ny {
            0.0
        } else {
            difference(row, next(iy))
        }
    });
    [
        (root(across_x, ny), root(steps_x, (nx - 1) * ny)),
        (root(across_y, nx), root(steps_y, nx * (ny - 1))),
    ]
}

/// Index of the signed mode (k, l) in a half spectrum stored by columns, for `k >= 0`.
#[cfg(test)]
fn mode_index(grid: &Grid, k: usize, l: i64) -> usize {
    let ky = l.rem_euclid(grid.ny as i64) as usize;
    assert_eq!(crate::grid::signed_index(ky, grid.ny), l);
    k * grid.ny + ky
}

#[cfg(test)]
#[path = "statistics_tests.rs"]
mod tests;
