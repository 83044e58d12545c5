//! The unbounded half-space under pixels of constant pressure (Love 1929).

use std::f64::consts::PI;
use std::ops::Range;

use rayon::prelude::*;
use rustfft::num_complex::Complex;

use crate::plans::Planned;

/// `(y + b)` times the difference of two inverse hyperbolic sines, with 0 times infinity = 0.
fn edge_term(across: f64, near: f64, far: f64) -> f64 {
    if across == 0.0 {
        return 0.0;
    }
    let width = across.abs();
    across * ((far / width).asinh() - (near / width).asinh())
}

/// Normal displacement at (x, y) of a half-space of unit contact modulus under unit pressure on the
/// rectangle `|x| < half_x, |y| < half_y`. Same length unit throughout.
///
/// # Source
/// Love 1929, doi:10.1098/rsta.1929.0009; Johnson 1985, eq. 3.25.
pub fn love_displacement(x: f64, y: f64, half_x: f64, half_y: f64) -> f64 {
    (edge_term(x + half_x, y - half_y, y + half_y) - edge_term(x - half_x, y - half_y, y + half_y)
        + edge_term(y + half_y, x - half_x, x + half_x)
        - edge_term(y - half_y, x - half_x, x + half_x))
        / PI
}

/// The displacement of an unbounded half-space between the points of a doubled grid, on its way to the stiffness at each
/// wavevector: rows are transformed along x, and columns of all rows along y.
///
/// The kernel is circulant, its offsets the nearest images: exact between points at most half the doubled grid apart. It
/// is even in both directions, so that half of its rows suffice and its spectra are real.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeKernel {
    /// Points of the doubled grid along x and y.
    points: [usize; 2],
    /// Sides of a pixel in reduced units.
    pixel: [f64; 2],
}

impl FreeKernel {
    /// The kernel of so many `points` of a doubled grid, with these sides of a pixel in reduced units.
    pub fn new(points: [usize; 2], pixel: [f64; 2]) -> Self {
        FreeKernel { points, pixel }
    }

    /// Columns of the half spectrum, nx/2 + 1.
    pub fn columns(&self) -> usize {
        self.points[0] / 2 + 1
    }

    /// Rows that suffice, ny/2 + 1.
    pub fn rows(&self) -> usize {
        self.points[1] / 2 + 1
    }

    /// The transforms along x of some of these rows, one after another, each of a value for each column.
    pub fn transformed_rows(&self, rows: Range<usize>) -> Vec<f64> {
        let ([nx, _], [dx, dy]) = (self.points, self.pixel);
        let plan = f64::real_forward(nx);
        let mut transformed = vec![0.0; rows.len() * self.columns()];
        let lines = transformed.par_chunks_exact_mut(self.columns());
        lines.zip(rows).for_each(|(line, row)| {
            let y = row as f64 * dy;
            let mut values: Vec<f64> = (0..nx)
                .map(|column| {
                    let x = column.min(nx - column) as f64 * dx;
                    love_displacement(x, y, 0.5 * dx, 0.5 * dy)
                })
                .collect();
            let mut spectrum = plan.make_output_vec();
            // Lengths are those of the plan, so this cannot fail.
            let _ = plan.process(&mut values, &mut spectrum);
            for (to, value) in line.iter_mut().zip(&spectrum) {
                *to = value.re;
            }
        });
        transformed
    }

    /// Makes columns of these rows, each of a value for each row and one column after another, the stiffness of their
    /// wavevectors.
    pub fn transform_columns(&self, columns: &mut [f64]) {
        let [_, ny] = self.points;
        let plan = f64::complex_forward(ny);
        columns
            .par_chunks_exact_mut(self.rows())
            .for_each(|column| {
                let mut line: Vec<Complex<f64>> = (0..ny)
                    .map(|row| Complex::new(column[row.min(ny - row)], 0.0))
                    .collect();
                plan.process(&mut line);
                for (to, value) in column.iter_mut().zip(line) {
                    *to = 1.0 / value.re;
                }
            });
    }
}

/// Stiffness of an unbounded half-space between the points of a doubled grid, in Fourier space.
///
/// `points` are those of the doubled grid, `pixel` the pixel sides in reduced units. Shape `[nx/2 +
/// 1, ny/2 + 1]`, the column (x) index running slowest: the inverse of the transform of the
/// [kernel](FreeKernel). All values are positive.
pub fn free_stiffness(points: [usize; 2], pixel: [f64; 2]) -> Vec<f64> {
    let kernel = FreeKernel::new(points, pixel);
    let rows = kernel.transformed_rows(0..kernel.rows());
    let mut columns: Vec<f64> = (0..kernel.columns())
        .flat_map(|column| rows.iter().skip(column).step_by(kernel.columns()))
        .copied()
        .collect();
    drop(rows);
    kernel.transform_columns(&mut columns);
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Unit square, unit pressure: the closed form at the centre, and two neighbours from an
    /// independent computation.
    #[test]
    fn unit_square() {
        let at = |x, y| love_displacement(x, y, 0.5, 0.5);
        assert!((at(0.0, 0.0) - 4.0 * (1.0 + 2f64.sqrt()).ln() / PI).abs() < 1e-14);
        assert!((at(1.0, 0.0) - 0.330421493).abs() < 1e-9);
        assert!((at(1.0, 1.0) - 0.230678359).abs() < 1e-9);
        assert!((at(300.0, 400.0) * PI * 500.0 - 1.0).abs() < 1e-6);
    }

    /// For square pixels the least compliance is that of the checkerboard, 0.5807 pixels, and the
    /// largest is 1.122 times the doubled side.
    #[test]
    fn bounds_of_the_free_spectrum() {
        for side in [16, 32, 50] {
            let stiffness = free_stiffness([side, side], [1.0, 1.0]);
            let largest = stiffness.iter().copied().fold(0.0, f64::max);
            assert!((1.0 / largest - 0.5807).abs() < 2e-3, "{side}: {largest}");
            let zero = 1.0 / stiffness[0];
            assert!((zero / side as f64 - 1.122).abs() < 2e-3, "{side}: {zero}");
            assert!(stiffness.iter().all(|&value| value > 0.0));
        }
    }
}
