//! Two-dimensional real Fourier transforms of a whole surface.
//!
//! A half spectrum is stored by columns: element `kx * ny + ky` for `kx = 0 .. columns`, all `ky`.
//! Columns beyond those stored are zero, so a band-limited surface needs no full spectrum.

use std::ops::DerefMut;
use std::sync::Arc;

use num_complex::Complex;
use rayon::prelude::*;
use rustfft::Fft;

use crate::backend::long_field::LongField;
use crate::grid::Grid;
use crate::plans::Planned;

/// Rows processed together, so that a cache line of a column serves several of them.
const ROWS_TOGETHER: usize = 8;
/// Columns processed together, so that a cache line of a row serves several of them.
const COLUMNS_TOGETHER: usize = 8;

/// Heights `h(x) = sum H exp(i q x)` from the coefficients H of the stored columns `kx = 0 ..`.
///
/// `columns` has length `stored * ny` with `stored <= nx/2 + 1`; the missing half follows from
/// `H(-q) = conj H(q)`. Returns shape `[ny, nx]`. No factor is applied: the coefficients are those of
/// the sum, not of an unscaled transform.
pub fn synthesise(
    grid: &Grid,
    mut columns: impl DerefMut<Target = [Complex<f64>]> + Sync,
) -> Vec<f64> {
    let (nx, ny) = (grid.nx, grid.ny);
    debug_assert!(columns.len().is_multiple_of(ny) && columns.len() / ny <= nx / 2 + 1);
    transform_columns(&mut columns, ny, &f64::complex_backward(ny));

    let along_x = f64::real_backward(nx);
    let mut heights = vec![0.0; nx * ny];
    heights
        .par_chunks_mut(nx * ROWS_TOGETHER)
        .enumerate()
        .for_each_init(
            || (along_x.make_input_vec(), along_x.make_scratch_vec()),
            |(row_spectrum, scratch), (chunk, rows)| {
                for (offset, row) in rows.chunks_mut(nx).enumerate() {
                    let iy = chunk * ROWS_TOGETHER + offset;
                    fill_row(
                        nx,
                        row_spectrum,
                        columns.chunks(ny).map(|column| column[iy]),
                    );
                    along_x
                        .process_with_scratch(row_spectrum, row, scratch)
                        .expect("all lengths come from the plan and the ends are real");
                }
            },
        );
    heights
}

/// Transforms columns of `ny` numbers each in their places.
pub(super) fn transform_columns(
    columns: &mut [Complex<f64>],
    ny: usize,
    along_y: &Arc<dyn Fft<f64>>,
) {
    columns.par_chunks_mut(ny).for_each_init(
        || vec![Complex::default(); along_y.get_inplace_scratch_len()],
        |scratch, column| along_y.process_with_scratch(column, scratch),
    );
}

/// Fills the half spectrum of a row of `nx` points, which the transform uses as scratch, with its coefficients; those
/// that are missing are zero.
pub(super) fn fill_row(
    nx: usize,
    spectrum: &mut [Complex<f64>],
    coefficients: impl Iterator<Item = Complex<f64>>,
) {
    spectrum.fill(Complex::default());
    for (value, coefficient) in spectrum.iter_mut().zip(coefficients) {
        *value = coefficient;
    }
    // Real by symmetry; the transform would refuse a rounding error in the imaginary part.
    spectrum[0].im = 0.0;
    if nx.is_multiple_of(2) {
        spectrum[nx / 2].im = 0.0;
    }
}

/// Half spectra of rows of heights, unscaled, row by row.
pub(super) fn spectrum_of_rows(grid: &Grid, heights: &[f64]) -> LongField<Complex<f64>> {
    let (nx, stored) = (grid.nx, grid.nx / 2 + 1);
    let along_x = f64::real_forward(nx);
    let mut rows = LongField::zeros(stored * (heights.len() / nx));
    rows.par_chunks_mut(stored)
        .zip(heights.par_chunks(nx))
        .for_each_init(
            || (along_x.make_input_vec(), along_x.make_scratch_vec()),
            |(input, scratch), (row_spectrum, row)| {
                input.copy_from_slice(row);
                along_x
                    .process_with_scratch(input, row_spectrum, scratch)
                    .expect("all lengths come from the plan");
            },
        );
    rows
}

/// `of_column` of each column of the spectrum that [`analyse`] finds, in their order, without the memory of all.
pub fn analyse_each<R: Send>(
    grid: &Grid,
    heights: &[f64],
    of_column: impl Fn(usize, &[Complex<f64>]) -> R + Sync,
) -> Vec<R> {
    let ny = grid.ny;
    let stored = grid.nx / 2 + 1;
    let rows = spectrum_of_rows(grid, heights);
    let along_y = f64::complex_forward(ny);
    let factor = 1.0 / grid.len() as f64;
    let groups = (0..stored.div_ceil(COLUMNS_TOGETHER)).into_par_iter();
    let found: Vec<Vec<R>> = groups
        .map_init(
            || {
                let scratch = vec![Complex::default(); along_y.get_inplace_scratch_len()];
                (vec![Complex::default(); COLUMNS_TOGETHER * ny], scratch)
            },
            |(columns, scratch), group| {
                let first = group * COLUMNS_TOGETHER;
                let last = stored.min(first + COLUMNS_TOGETHER);
                for (iy, row) in rows.chunks_exact(stored).enumerate() {
                    for (column, value) in columns.chunks_exact_mut(ny).zip(&row[first..last]) {
                        column[iy] = value * factor;
                    }
                }
                let columns = (first..last).zip(columns.chunks_exact_mut(ny));
                columns
                    .map(|(kx, column)| {
                        along_y.process_with_scratch(column, scratch);
                        of_column(kx, column)
                    })
                    .collect()
            },
        )
        .collect();
    found.into_iter().flatten().collect()
}

/// Coefficients `H = sum h exp(-i q x) / (nx ny)` of all columns `kx = 0 ..= nx/2`.
///
/// The inverse of [`synthesise`]; needs as much memory as the heights.
pub fn analyse(grid: &Grid, heights: &[f64]) -> Vec<Complex<f64>> {
    let ny = grid.ny;
    let stored = grid.nx / 2 + 1;
    let rows = spectrum_of_rows(grid, heights);
    let along_y = f64::complex_forward(ny);
    let factor = 1.0 / grid.len() as f64;
    let mut columns = vec![Complex::default(); stored * ny];
    columns.par_chunks_mut(ny).enumerate().for_each_init(
        || vec![Complex::default(); along_y.get_inplace_scratch_len()],
        |scratch, (kx, column)| {
            for (value, row_spectrum) in column.iter_mut().zip(rows.chunks(stored)) {
                *value = row_spectrum[kx] * factor;
            }
            along_y.process_with_scratch(column, scratch);
        },
    );
    columns
}
