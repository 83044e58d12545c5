//! Least-squares surfaces through a measured height map: the mean, a plane or a quadratic that is removed, or the mean of each row.

use nalgebra::{DMatrix, DVector};

use crate::backend::Share;
use crate::scene::Detrend;

/// Most terms of a surface, and the sums of their least squares: the products of each two, and those with the heights.
const TERMS: usize = 6;
const SUMS: usize = TERMS * TERMS + TERMS;

/// Subtracts the least-squares surface of the given kind from `heights`, the rows of a map that this process holds,
/// row-major.
///
/// On a map too narrow for a term (two columns and a quadratic) the solution of least norm is
/// taken.
pub(super) fn detrend(heights: &mut [f64], share: &Share, kind: Detrend) {
    let [columns, rows] = share.surface();
    let terms = match kind {
        Detrend::None => return,
        Detrend::Lines => {
            for row in heights.chunks_exact_mut(columns) {
                let mean = row.iter().sum::<f64>() / columns as f64;
                row.iter_mut().for_each(|height| *height -= mean);
            }
            return;
        }
        Detrend::Mean => 1,
        Detrend::Plane => 3,
        Detrend::Quadratic => TERMS,
    };
    let count = (columns * rows) as f64;
    let first = share.surface_rows().start * columns;
    // Subtract the mean first: a large offset would cost digits in the sums.
    let mean = share.surface_sum_by(heights, |height| height) / count;
    heights.iter_mut().for_each(|height| *height -= mean);
    let Some(trend) = Trend::through(heights, share, terms, count) else {
        return;
    };
    for (index, height) in heights.iter_mut().enumerate() {
        *height -= trend.at(first + index);
    }
}

/// A least-squares surface on the pixels of a map.
pub(super) struct Trend {
    coefficients: Vec<f64>,
    columns: usize,
    rows: usize,
}

impl Trend {
    /// The plane through the known ones of the heights less their mean, which are so many; the others are not finite. `None` where it
    /// is not found.
    pub fn plane(heights: &[f64], share: &Share, mean: f64, known: f64) -> Option<Trend> {
        let less_mean: Vec<f64> = heights.iter().map(|height| height - mean).collect();
        Trend::through(&less_mean, share, 3, known)
    }

    /// That of so many terms through the known ones of the heights, which are so many.
    fn through(heights: &[f64], share: &Share, terms: usize, known: f64) -> Option<Trend> {
        let [columns, rows] = share.surface();
        let first = share.surface_rows().start * columns;
        let sums: [f64; SUMS] = share.sums(heights.len() / columns, |row, sums| {
            let (products, load) = sums.split_at_mut(TERMS * TERMS);
            let line = line(heights, row, columns);
            for (index, height) in line.filter(|(_, height)| height.is_finite()) {
                let basis = basis(first + index, rows, columns);
                for (i, one) in basis.iter().take(terms).enumerate() {
                    load[i] += one * height;
                    for (j, other) in basis.iter().take(terms).enumerate() {
                        products[i * TERMS + j] += one * other;
                    }
                }
            }
        });
        let normal = DMatrix::from_fn(terms, terms, |i, j| sums[i * TERMS + j]);
        let load = DVector::from_fn(terms, |i, _| sums[TERMS * TERMS + i]);
        // Scaled so that a term that a narrow map cannot determine has a singular value of 0 up to
        // rounding.
        let found = (normal / known).svd(true, true);
        let coefficients = found.solve(&(load / known), 1e-12).ok()?;
        Some(Trend {
            coefficients: coefficients.iter().copied().collect(),
            columns,
            rows,
        })
    }

    /// Its height at a pixel of the map.
    pub fn at(&self, index: usize) -> f64 {
        let basis = basis(index, self.rows, self.columns);
        let terms = basis.iter().zip(&self.coefficients);
        terms.map(|(b, c)| b * c).sum()
    }
}

/// Rms height of the least-squares plane over that of the map, about the mean; 0 of a flat map.
pub(super) fn tilt(heights: &[f64], share: &Share) -> f64 {
    let [columns, rows] = share.surface();
    let first = share.surface_rows().start * columns;
    let mean = share.surface_sum_by(heights, |height| height) / (columns * rows) as f64;
    // x and y are orthogonal, and each has the mean 0.
    let sums: [f64; 5] = share.sums(heights.len() / columns, |row, sums| {
        let [square, along_x, along_y, length_x, length_y] = sums;
        for (index, height) in line(heights, row, columns) {
            let [_, x, y, ..] = basis(first + index, rows, columns);
            let height = height - mean;
            *square += height * height;
            *along_x += x * height;
            *along_y += y * height;
            *length_x += x * x;
            *length_y += y * y;
        }
    });
    let [square, products @ .., length_x, length_y] = sums;
    let lengths = [length_x, length_y];
    let plane: f64 = (0..2)
        .filter(|axis| lengths[*axis] > 0.0)
        .map(|axis| products[axis].powi(2) / lengths[axis])
        .sum();
    if square > 0.0 {
        (plane / square).sqrt()
    } else {
        0.0
    }
}

/// A row of heights, with the places of its points.
fn line(heights: &[f64], row: usize, columns: usize) -> impl Iterator<Item = (usize, f64)> {
    let start = row * columns;
    (start..).zip(heights[start..start + columns].iter().copied())
}

/// The terms 1, x, y, x^2, x y, y^2 at a pixel, with x and y from -1 to 1 across the map.
fn basis(index: usize, rows: usize, columns: usize) -> [f64; 6] {
    let across = |at: usize, count: usize| {
        if count > 1 {
            2.0 * at as f64 / (count - 1) as f64 - 1.0
        } else {
            0.0
        }
    };
    let (x, y) = (
        across(index % columns, columns),
        across(index / columns, rows),
    );
    [1.0, x, y, x * x, x * y, y * y]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::Shape;
    use approx::assert_abs_diff_eq;

    fn all(rows: usize, columns: usize) -> Share {
        Share::whole(Shape::whole(columns, rows))
    }

    /// 9 rows, 7 columns: a quadratic on an offset a million times as large.
    fn quadratic(terms: usize) -> Vec<f64> {
        (0..63)
            .map(|index| {
                let coefficients = [1e6, 2.0, -3.0, 0.5, 4.0, -1.0];
                let basis = basis(index, 9, 7);
                basis
                    .iter()
                    .zip(coefficients)
                    .take(terms)
                    .map(|(b, c)| b * c)
                    .sum()
            })
            .collect()
    }

    #[test]
    fn each_kind_takes_off_its_own_terms() {
        for (kind, terms) in [
            (Detrend::Mean, 1),
            (Detrend::Plane, 3),
            (Detrend::Quadratic, 6),
        ] {
            let mut heights = quadratic(terms);
            detrend(&mut heights, &all(9, 7), kind);
            for height in heights {
                assert_abs_diff_eq!(height, 0.0, epsilon = 1e-8);
            }
        }
        let mut heights = quadratic(6);
        detrend(&mut heights, &all(9, 7), Detrend::None);
        assert_eq!(heights, quadratic(6));
    }

    #[test]
    fn a_detrended_map_has_no_mean_and_no_slope() {
        let mut heights: Vec<f64> = (0..63).map(|i| ((i * 37) % 11) as f64).collect();
        detrend(&mut heights, &all(9, 7), Detrend::Plane);
        for term in 0..3 {
            let product: f64 = (0..63).map(|i| basis(i, 9, 7)[term] * heights[i]).sum();
            assert_abs_diff_eq!(product, 0.0, epsilon = 1e-10);
        }
    }

    #[test]
    fn lines_lose_their_means_and_a_tilt_is_measured() {
        let mut heights = quadratic(3);
        assert_abs_diff_eq!(tilt(&heights, &all(9, 7)), 1.0, epsilon = 1e-9);
        detrend(&mut heights, &all(9, 7), Detrend::Lines);
        for (index, height) in heights.iter().enumerate() {
            assert_abs_diff_eq!(*height, 2.0 * basis(index, 9, 7)[1], epsilon = 1e-8);
        }
        // A plane of rms height 1 under noise of rms height 1 is orthogonal to what remains without it.
        let mut noise: Vec<f64> = (0..63).map(|i| ((i * 37) % 11) as f64).collect();
        detrend(&mut noise, &all(9, 7), Detrend::Plane);
        assert_abs_diff_eq!(tilt(&noise, &all(9, 7)), 0.0, epsilon = 1e-12);
        assert_eq!(tilt(&[2.0; 6], &all(2, 3)), 0.0);
    }

    #[test]
    fn narrow_maps_are_detrended() {
        for (rows, columns) in [(1, 1), (1, 2), (2, 1), (2, 2), (1, 9), (3, 1)] {
            let mut heights: Vec<f64> = (0..rows * columns).map(|i| i as f64).collect();
            detrend(&mut heights, &all(rows, columns), Detrend::Quadratic);
            for height in heights {
                assert_abs_diff_eq!(height, 0.0, epsilon = 1e-9);
            }
        }
    }
}
