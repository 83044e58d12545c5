//! Removes the mean, a plane or a quadratic from a measured height map by least squares, or the mean of each row.

use nalgebra::{DMatrix, DVector};

use crate::scene::Detrend;

/// Subtracts the least-squares surface of the given kind from `heights`, shape `[rows, columns]`,
/// row-major.
///
/// On a map too narrow for a term (two columns and a quadratic) the solution of least norm is
/// taken.
pub(super) fn detrend(heights: &mut [f64], rows: usize, columns: usize, kind: Detrend) {
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
        Detrend::Quadratic => 6,
    };
    // Subtract the mean first: a large offset would cost digits in the sums.
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    let mut normal = DMatrix::zeros(terms, terms);
    let mut load = DVector::zeros(terms);
    for (index, height) in heights.iter_mut().enumerate() {
        *height -= mean;
        let basis = basis(index, rows, columns);
        for (i, first) in basis.iter().take(terms).enumerate() {
            load[i] += first * *height;
            for (j, second) in basis.iter().take(terms).enumerate() {
                normal[(i, j)] += first * second;
            }
        }
    }
    // Scaled so that a term that a narrow map cannot determine has a singular value of 0 up to
    // rounding.
    let count = heights.len() as f64;
    let Ok(coefficients) = (normal / count)
        .svd(true, true)
        .solve(&(load / count), 1e-12)
    else {
        return;
    };
    for (index, height) in heights.iter_mut().enumerate() {
        let basis = basis(index, rows, columns);
        let trend: f64 = basis
            .iter()
            .zip(coefficients.iter())
            .map(|(b, c)| b * c)
            .sum();
        *height -= trend;
    }
}

/// Rms height of the least-squares plane over that of the map, about the mean; 0 of a flat map.
pub(super) fn tilt(heights: &[f64], rows: usize, columns: usize) -> f64 {
    let mean = heights.iter().sum::<f64>() / heights.len() as f64;
    // x and y are orthogonal, and each has the mean 0.
    let (mut square, mut products, mut lengths) = (0.0, [0.0; 2], [0.0; 2]);
    for (index, height) in heights.iter().enumerate() {
        let [_, x, y, ..] = basis(index, rows, columns);
        let height = height - mean;
        square += height * height;
        for (axis, place) in [x, y].into_iter().enumerate() {
            products[axis] += place * height;
            lengths[axis] += place * place;
        }
    }
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
    use approx::assert_abs_diff_eq;

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
            detrend(&mut heights, 9, 7, kind);
            for height in heights {
                assert_abs_diff_eq!(height, 0.0, epsilon = 1e-8);
            }
        }
        let mut heights = quadratic(6);
        detrend(&mut heights, 9, 7, Detrend::None);
        assert_eq!(heights, quadratic(6));
    }

    #[test]
    fn a_detrended_map_has_no_mean_and_no_slope() {
        let mut heights: Vec<f64> = (0..63).map(|i| ((i * 37) % 11) as f64).collect();
        detrend(&mut heights, 9, 7, Detrend::Plane);
        for term in 0..3 {
            let product: f64 = (0..63).map(|i| basis(i, 9, 7)[term] * heights[i]).sum();
            assert_abs_diff_eq!(product, 0.0, epsilon = 1e-10);
        }
    }

    #[test]
    fn lines_lose_their_means_and_a_tilt_is_measured() {
        let mut heights = quadratic(3);
        assert_abs_diff_eq!(tilt(&heights, 9, 7), 1.0, epsilon = 1e-9);
        detrend(&mut heights, 9, 7, Detrend::Lines);
        for (index, height) in heights.iter().enumerate() {
            assert_abs_diff_eq!(*height, 2.0 * basis(index, 9, 7)[1], epsilon = 1e-8);
        }
        // A plane of rms height 1 under noise of rms height 1 is orthogonal to what remains without it.
        let mut noise: Vec<f64> = (0..63).map(|i| ((i * 37) % 11) as f64).collect();
        detrend(&mut noise, 9, 7, Detrend::Plane);
        assert_abs_diff_eq!(tilt(&noise, 9, 7), 0.0, epsilon = 1e-12);
        assert_eq!(tilt(&[2.0; 6], 2, 3), 0.0);
    }

    #[test]
    fn narrow_maps_are_detrended() {
        for (rows, columns) in [(1, 1), (1, 2), (2, 1), (2, 2), (1, 9), (3, 1)] {
            let mut heights: Vec<f64> = (0..rows * columns).map(|i| i as f64).collect();
            detrend(&mut heights, rows, columns, Detrend::Quadratic);
            for height in heights {
                assert_abs_diff_eq!(height, 0.0, epsilon = 1e-9);
            }
        }
    }
}
