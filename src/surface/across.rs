//! Fourier transforms of a surface whose rows lie on several ranks: each takes some columns at a time from all, so that no
//! rank holds more than its rows of heights and of their spectrum. The lines are those of one process, and so are the
//! bits.

use std::ops::Range;

use num_complex::Complex;
use rayon::prelude::*;

use super::fourier::{fill_row, spectrum_of_rows, transform_columns};
use crate::backend::{BackendError, Share};
use crate::grid::Grid;
use crate::plans::Planned;

/// Bytes of the columns that a rank takes at once.
const ROUND: usize = 16 << 20;

/// Columns by round and rank.
struct Rounds {
    columns: usize,
    ranks: usize,
    at_once: usize,
}

impl Rounds {
    /// Rounds over so many columns of `ny` numbers.
    fn new(columns: usize, ny: usize, ranks: usize) -> Rounds {
        let most = (ROUND / (size_of::<Complex<f64>>() * ny)).max(1);
        Rounds {
            columns,
            ranks,
            at_once: most.min(columns.div_ceil(ranks)).max(1),
        }
    }

    fn count(&self) -> usize {
        self.columns.div_ceil(self.at_once * self.ranks)
    }

    /// The columns of a rank in a round.
    fn of(&self, round: usize, rank: usize) -> Range<usize> {
        let start = (round * self.ranks + rank) * self.at_once;
        start.min(self.columns)..(start + self.at_once).min(self.columns)
    }
}

/// The columns that this rank transforms in a round, from the held rows of the spectra of rows, times a factor.
fn columns_of_rows(
    share: &Share,
    (rounds, round): (&Rounds, usize),
    spectra: &[Complex<f64>],
    stored: usize,
    factor: f64,
) -> Result<Vec<Complex<f64>>, BackendError> {
    let (rows, ny) = (share.surface_rows(), share.surface()[1]);
    let own = rounds.of(round, share.rank());
    let mut sent = Vec::new();
    let mut lengths = Vec::with_capacity(share.count());
    for rank in 0..share.count() {
        let theirs = rounds.of(round, rank);
        lengths.push(2 * theirs.len() * rows.len());
        for k in theirs {
            let values = spectra.chunks_exact(stored).map(|line| line[k] * factor);
            sent.extend(values.flat_map(|value| [value.re, value.im]));
        }
    }
    let expected = (0..share.count()).map(|rank| 2 * share.surface_rows_of(rank).len() * own.len());
    let received = share.exchange(&sent, &lengths, &expected.collect::<Vec<_>>())?;
    let (mut pairs, _) = received.as_chunks::<2>();
    let mut columns = vec![Complex::default(); own.len() * ny];
    for rank in 0..share.count() {
        let theirs = share.surface_rows_of(rank);
        for column in columns.chunks_exact_mut(ny) {
            let (part, rest) = pairs.split_at(theirs.len());
            for (value, &[re, im]) in column[theirs.clone()].iter_mut().zip(part) {
                *value = Complex::new(re, im);
            }
            pairs = rest;
        }
    }
    Ok(columns)
}

/// Puts the columns of a round, of which this rank has its own, into the held rows of the spectra of rows.
fn rows_of_columns(
    share: &Share,
    (rounds, round): (&Rounds, usize),
    columns: &[Complex<f64>],
    spectra: &mut [Complex<f64>],
) -> Result<(), BackendError> {
    let (rows, ny) = (share.surface_rows(), share.surface()[1]);
    let mut sent = Vec::with_capacity(2 * columns.len());
    let mut lengths = Vec::with_capacity(share.count());
    for rank in 0..share.count() {
        let theirs = share.surface_rows_of(rank);
        lengths.push(2 * theirs.len() * columns.len() / ny);
        for column in columns.chunks_exact(ny) {
            let values = column[theirs.clone()].iter();
            sent.extend(values.flat_map(|value| [value.re, value.im]));
        }
    }
    let expected = (0..share.count()).map(|rank| 2 * rows.len() * rounds.of(round, rank).len());
    let received = share.exchange(&sent, &lengths, &expected.collect::<Vec<_>>())?;
    let (pairs, _) = received.as_chunks::<2>();
    let taken = (0..share.count()).flat_map(|rank| rounds.of(round, rank));
    for (k, column) in taken.zip(pairs.chunks_exact(rows.len().max(1))) {
        for (line, &[re, im]) in spectra.chunks_exact_mut(rounds.columns).zip(column) {
            line[k] = Complex::new(re, im);
        }
    }
    Ok(())
}

/// The heights of rows of `nx` points, of which the spectra have so many columns.
fn heights_of_rows(nx: usize, stored: usize, spectra: &[Complex<f64>]) -> Vec<f64> {
    let along_x = f64::real_backward(nx);
    let mut heights = vec![0.0; nx * (spectra.len() / stored)];
    let lines = heights.par_chunks_mut(nx).zip(spectra.par_chunks(stored));
    lines.for_each_init(
        || (along_x.make_input_vec(), along_x.make_scratch_vec()),
        |(spectrum, scratch), (row, line)| {
            fill_row(nx, spectrum, line.iter().copied());
            along_x
                .process_with_scratch(spectrum, row, scratch)
                .expect("all lengths come from the plan and the ends are real");
        },
    );
    heights
}

/// The rows of the heights of [`synthesise`](super::fourier::synthesise) that this rank holds; `fill` sets the
/// coefficients of one of the `stored` columns, which are zeros.
///
/// # Errors
/// A rank has ended.
pub fn synthesise(
    grid: &Grid,
    share: &Share,
    stored: usize,
    fill: impl Fn(usize, &mut [Complex<f64>]) + Sync,
) -> Result<Vec<f64>, BackendError> {
    let ny = grid.ny;
    let rounds = Rounds::new(stored, ny, share.count());
    // Row by row, the stored columns of each.
    let mut spectra = vec![Complex::default(); stored * share.surface_rows().len()];
    for round in 0..rounds.count() {
        let own = rounds.of(round, share.rank());
        let mut columns = vec![Complex::default(); own.len() * ny];
        let lines = columns.par_chunks_mut(ny).zip(own);
        lines.for_each(|(column, k)| fill(k, column));
        transform_columns(&mut columns, ny, &f64::complex_backward(ny));
        rows_of_columns(share, (&rounds, round), &columns, &mut spectra)?;
    }
    Ok(heights_of_rows(grid.nx, stored, &spectra))
}

/// `of_column` of each column of the spectrum that [`analyse`](super::fourier::analyse) finds, in their order; the
/// heights are those of the held rows.
///
/// # Errors
/// A rank has ended.
pub fn analyse<const N: usize>(
    grid: &Grid,
    share: &Share,
    heights: &[f64],
    of_column: impl Fn(usize, &[Complex<f64>]) -> [f64; N] + Sync,
) -> Result<Vec<[f64; N]>, BackendError> {
    let ny = grid.ny;
    let stored = grid.nx / 2 + 1;
    let rounds = Rounds::new(stored, ny, share.count());
    let spectra = spectrum_of_rows(grid, heights);
    let factor = 1.0 / grid.len() as f64;
    let mut found = Vec::with_capacity(stored);
    for round in 0..rounds.count() {
        let mut columns = columns_of_rows(share, (&rounds, round), &spectra, stored, factor)?;
        transform_columns(&mut columns, ny, &f64::complex_forward(ny));
        let lines = columns.par_chunks(ny).zip(rounds.of(round, share.rank()));
        let numbers: Vec<[f64; N]> = lines.map(|(column, k)| of_column(k, column)).collect();
        let counts = (0..share.count()).map(|rank| N * rounds.of(round, rank).len());
        let all = share.numbers(numbers.as_flattened(), counts)?;
        let (all, _) = all.as_chunks::<N>();
        found.extend_from_slice(all);
    }
    Ok(found)
}

/// Heights of the held rows of one share's map from those of another's: `bring` takes each of the first columns of their
/// spectrum, so many, to one of the new, which is zeros; the others are zeros.
///
/// # Errors
/// A rank has ended.
pub fn bring(
    [from, to]: [&Share; 2],
    heights: Vec<f64>,
    columns: usize,
    bring: impl Fn(usize, &[Complex<f64>], &mut [Complex<f64>]) + Sync,
) -> Result<Vec<f64>, BackendError> {
    let [old, new] = [from, to].map(|share| Grid::new(share.surface(), [1.0; 2]));
    let stored = old.nx / 2 + 1;
    let rounds = Rounds::new(columns, old.ny.max(new.ny), from.count());
    let spectra = spectrum_of_rows(&old, &heights);
    drop(heights);
    let factor = 1.0 / old.len() as f64;
    let mut brought = vec![Complex::default(); columns * to.surface_rows().len()];
    for round in 0..rounds.count() {
        let mut waves = columns_of_rows(from, (&rounds, round), &spectra, stored, factor)?;
        transform_columns(&mut waves, old.ny, &f64::complex_forward(old.ny));
        let own = rounds.of(round, from.rank());
        let mut found = vec![Complex::default(); own.len() * new.ny];
        let lines = waves.par_chunks(old.ny).zip(found.par_chunks_mut(new.ny));
        lines
            .zip(own)
            .for_each(|((waves, found), k)| bring(k, waves, found));
        drop(waves);
        transform_columns(&mut found, new.ny, &f64::complex_backward(new.ny));
        rows_of_columns(to, (&rounds, round), &found, &mut brought)?;
    }
    drop(spectra);
    Ok(heights_of_rows(new.nx, columns, &brought))
}
