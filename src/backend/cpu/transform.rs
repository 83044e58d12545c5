//! Real two-dimensional transforms in three parts: rows, columns with the factor between, rows.
//!
//! Spectra of a block of rows are stored in tiles of eight columns by eight rows, so that the
//! transposition between rows and columns moves whole cache lines both ways, and columns go back to the
//! places from which they came.

use parking_lot::{Mutex, MutexGuard};
use pulp::{Arch, Simd, WithSimd};
use rustfft::Fft;
use rustfft::num_complex::Complex;
use rustfft::num_traits::Zero;

use super::CpuReal;
use super::across::{PAIR, Pieces, lay, take_up};
use super::blocks::{BLOCK, Job, TILE, Tile, run_blocks};
use super::plans::Plans;
use crate::backend::Shape;
use crate::backend::long_field::LongField;
use crate::kernel::Form;
use crate::real::Real;

/// Transform plans and work space of one level.
pub(super) struct Transform<T: CpuReal> {
    pub(super) shape: Shape,
    /// Rows that this process holds.
    rows: usize,
    /// Columns of the half spectrum, nx/2 + 1.
    columns: usize,
    /// Groups of `BLOCK` columns.
    pub(super) groups: usize,
    plans: Plans<T>,
    /// Spectra of the held rows, then of the columns too: block, group, column in the group, row in the block.
    spectra: LongField<Complex<T>>,
    /// Room for the tiles in the order of the columns; empty between two passes.
    by_columns: Vec<Option<&'static mut Tile<T>>>,
    /// Rows and columns on their way between ranks.
    pub(super) exchanged: [Vec<T>; 2],
    /// Energy of each group.
    energies: Vec<f64>,
    scratch: Vec<Mutex<Scratch<T>>>,
}

/// One thread's buffers.
struct Scratch<T> {
    lines: Vec<T>,
    spectra: Vec<Complex<T>>,
    column: Vec<Complex<T>>,
    /// Factors of one column.
    factors: Vec<T>,
    transform: Vec<Complex<T>>,
}

impl<T: CpuReal> Transform<T> {
    /// Transforms of a level of which this process holds so many rows.
    pub fn new(shape: Shape, rows: usize) -> Self {
        let [nx, ny] = shape.points;
        let columns = nx / 2 + 1;
        let groups = columns.div_ceil(BLOCK);
        let plans = Plans::<T>::new(shape.points);
        let transform_len = (plans.rows.scratch_len())
            .max(plans.column_forward.get_inplace_scratch_len())
            .max(plans.column_backward.get_inplace_scratch_len());
        let zero = Complex::<T>::zero();
        let scratch = (0..rayon::current_num_threads().max(1))
            .map(|_| {
                Mutex::new(Scratch {
                    lines: vec![T::zero(); BLOCK * nx],
                    spectra: vec![zero; BLOCK * columns],
                    column: vec![zero; BLOCK * ny],
                    factors: vec![T::zero(); ny],
                    transform: vec![zero; transform_len],
                })
            })
            .collect();
        Transform {
            shape,
            rows,
            columns,
            groups,
            plans,
            spectra: LongField::default(),
            by_columns: Vec::new(),
            exchanged: Default::default(),
            energies: vec![0.0; groups],
            scratch,
        }
    }

    /// Lets go of the spectra and of what was exchanged.
    pub fn release(&mut self) {
        self.spectra = LongField::default();
        self.by_columns = Vec::new();
        self.exchanged = Default::default();
    }

    /// Takes memory for the spectra, at first and after they were let go.
    pub(super) fn take(&mut self) {
        if self.spectra.is_empty() {
            let blocks = self.rows.div_ceil(BLOCK);
            self.spectra = LongField::zeros(blocks * self.groups * TILE);
        }
    }

    /// The spectra in tiles: block, group.
    pub(super) fn tiles(&self) -> &[Tile<T>] {
        self.spectra.as_chunks().0
    }

    /// The same, to write.
    pub(super) fn tiles_mut(&mut self) -> &mut [Tile<T>] {
        self.spectra.as_chunks_mut().0
    }

    /// Hands lines to the job's twin block by block: those of the inverse transform, or those that were
    /// kept in the place of the row spectra; keeps what it makes of them there, or transforms it.
    pub fn rows(&mut self, job: Job<T>, form: Form) {
        self.take();
        let Transform {
            ref mut spectra,
            ref scratch,
            ref plans,
            columns,
            groups,
            ..
        } = *self;
        let nx = self.shape.points[0];
        let job = Job {
            work: spectra.as_chunks_mut().0,
            work_per_block: groups,
            ..job
        };
        run_blocks(job, &|mut job| {
            let guard = &mut *lock(scratch);
            let (_, count) = job.rows_of(job.blocks.start);
            let lines = &mut guard.lines[..count * nx];
            if form.after_inverse() {
                plans.rows.part(job.work);
                for (group, tile) in job.work.iter_mut().enumerate() {
                    let spectra = &mut guard.spectra[..count * columns];
                    tile_to_rows(tile, spectra, columns, group * BLOCK);
                }
                for (line, spectrum) in lines
                    .chunks_exact_mut(nx)
                    .zip(guard.spectra.chunks_exact_mut(columns))
                {
                    plans.rows.backward(spectrum, line, &mut guard.transform);
                }
            }
            if form.takes_retained() {
                for (lines, tile) in lines.chunks_mut(2 * TILE).zip(&mut *job.work) {
                    take_retained(tile, lines);
                }
            }
            job.call(lines);
            if form.retains() {
                for (lines, tile) in lines.chunks(2 * TILE).zip(&mut *job.work) {
                    retain(lines, tile);
                }
            }
            if form.before_forward() {
                for (line, spectrum) in lines
                    .chunks_exact_mut(nx)
                    .zip(guard.spectra.chunks_exact_mut(columns))
                {
                    plans.rows.forward(line, spectrum, &mut guard.transform);
                }
                for (group, tile) in job.work.iter_mut().enumerate() {
                    let spectra = &guard.spectra[..count * columns];
                    rows_to_tile(spectra, columns, group * BLOCK, tile);
                }
                plans.rows.pair(job.work);
            }
        });
    }

    /// Transforms the columns, multiplies by `factors` (`[columns, ny/2 + 1]`), and transforms
    /// back. Returns `sum K |s_q|^2 / points` over all wavevectors.
    pub fn multiply(&mut self, factors: &[T], energy: bool) -> f64 {
        self.take();
        let mut spectra = std::mem::take(&mut self.spectra);
        let mut energies = std::mem::take(&mut self.energies);
        let mut by_columns = emptied(std::mem::take(&mut self.by_columns));
        let (tiles, _) = spectra.as_chunks_mut();
        let blocks = tiles.len() / self.groups;
        by_columns.resize_with(tiles.len(), || None);
        for (block, tiles) in tiles.chunks_exact_mut(self.groups).enumerate() {
            for (group, tile) in tiles.iter_mut().enumerate() {
                by_columns[group * blocks + block] = Some(tile);
            }
        }
        self.columns(factors, 0, energy)
            .run(0, &mut by_columns, &mut energies);
        self.by_columns = emptied(by_columns);
        (self.spectra, self.energies) = (spectra, energies);
        self.energies.iter().sum()
    }

    /// The columns, with their factors from that of column `first` on.
    pub(super) fn columns<'a>(
        &'a self,
        factors: &'a [T],
        first: usize,
        energy: bool,
    ) -> Columns<'a, T> {
        let [nx, ny] = self.shape.points;
        Columns {
            scratch: &self.scratch,
            forward: &*self.plans.column_forward,
            backward: &*self.plans.column_backward,
            factors,
            first,
            scale: T::from_double(1.0 / self.shape.len() as f64),
            columns: self.columns,
            nx,
            ny,
            energy,
        }
    }
}

/// Takes the spectra of rows, `[rows, columns]`, out of a tile, each from the tile's first column on.
///
/// Whole rows of a tile have a fixed length, which the compiler moves without a loop; only the last tile has others.
fn tile_to_rows<T: Real>(
    tile: &[Complex<T>; TILE],
    spectra: &mut [Complex<T>],
    columns: usize,
    first: usize,
) {
    for (row, spectrum) in spectra.chunks_exact_mut(columns).enumerate() {
        let spectrum = &mut spectrum[first..];
        if let Some(part) = spectrum.first_chunk_mut::<BLOCK>() {
            for (place, value) in part.iter_mut().enumerate() {
                *value = tile[place * BLOCK + row];
            }
        } else {
            for (place, value) in spectrum.iter_mut().enumerate() {
                *value = tile[place * BLOCK + row];
            }
        }
    }
}

/// Puts the spectra of rows, `[rows, columns]`, into a tile, each from the tile's first column on.
fn rows_to_tile<T: Real>(
    spectra: &[Complex<T>],
    columns: usize,
    first: usize,
    tile: &mut [Complex<T>; TILE],
) {
    for (row, spectrum) in spectra.chunks_exact(columns).enumerate() {
        let spectrum = &spectrum[first..];
        if let Some(part) = spectrum.first_chunk::<BLOCK>() {
            for (place, value) in part.iter().enumerate() {
                tile[place * BLOCK + row] = *value;
            }
        } else {
            for (place, value) in spectrum.iter().enumerate() {
                tile[place * BLOCK + row] = *value;
            }
        }
    }
}

/// Keeps lines in the place of a tile's spectra, two numbers in each.
fn retain<T: CpuReal>(lines: &[T], tile: &mut [Complex<T>; TILE]) {
    let kept: &mut [T] = bytemuck::cast_slice_mut(tile);
    kept[..lines.len()].copy_from_slice(lines);
}

/// Takes lines from the place of a tile's spectra.
fn take_retained<T: CpuReal>(tile: &[Complex<T>; TILE], lines: &mut [T]) {
    let kept: &[T] = bytemuck::cast_slice(tile);
    lines.copy_from_slice(&kept[..lines.len()]);
}

/// Copies some rows of a column, a whole block of them by a fixed length.
fn copy_rows<T: Real>(from: &[Complex<T>], to: &mut [Complex<T>]) {
    match (from.first_chunk::<BLOCK>(), to.first_chunk_mut::<BLOCK>()) {
        (Some(from), Some(to)) => *to = *from,
        _ => {
            let rows = from.len().min(to.len());
            to[..rows].copy_from_slice(&from[..rows]);
        }
    }
}

/// A list of references without them, to hold others: it keeps its memory, since the new list is collected in the old one's
/// place.
fn emptied<'a, T>(mut list: Vec<Option<&mut T>>) -> Vec<Option<&'a mut T>> {
    list.clear();
    list.into_iter().map(|_| None).collect()
}

/// This thread's buffers. Two threads of different pools may meet here; then one waits.
fn lock<T>(scratch: &[Mutex<Scratch<T>>]) -> MutexGuard<'_, Scratch<T>> {
    let index = rayon::current_thread_index().unwrap_or(0) % scratch.len();
    scratch[index].lock()
}

/// The column part, shared by all its threads.
pub(super) struct Columns<'a, T: Real> {
    scratch: &'a [Mutex<Scratch<T>>],
    forward: &'a dyn Fft<T>,
    backward: &'a dyn Fft<T>,
    factors: &'a [T],
    /// The column of the first of these factors.
    first: usize,
    scale: T,
    columns: usize,
    nx: usize,
    ny: usize,
    energy: bool,
}

impl<T: Real> Columns<'_, T> {
    /// Some groups from `first` on, with the tiles of each together; their energies.
    fn run(&self, first: usize, tiles: &mut [Option<&mut Tile<T>>], energies: &mut [f64]) {
        if let [energy] = energies {
            *energy = self.group(first, tiles);
        } else if !energies.is_empty() {
            let half = energies.len() / 2;
            let (left_tiles, right_tiles) = tiles.split_at_mut(tiles.len() / energies.len() * half);
            let (left, right) = energies.split_at_mut(half);
            rayon::join(
                || self.run(first, left_tiles, left),
                || self.run(first + half, right_tiles, right),
            );
        }
    }

    /// One group of columns, in the tiles that hold it.
    fn group(&self, group: usize, tiles: &mut [Option<&mut Tile<T>>]) -> f64 {
        let guard = &mut *lock(self.scratch);
        let ny = self.ny;
        let count = BLOCK.min(self.columns - group * BLOCK);
        for (block, tile) in tiles.iter().flatten().enumerate() {
            let rows = BLOCK.min(ny - block * BLOCK);
            for (place, line) in tile.chunks_exact(BLOCK).take(count).enumerate() {
                let at = place * ny + block * BLOCK;
                copy_rows(line, &mut guard.column[at..at + rows]);
            }
        }
        let mut column = std::mem::take(&mut guard.column);
        let energy = self.convolve(group, &mut column, guard);
        guard.column = column;
        for (block, tile) in tiles.iter_mut().flatten().enumerate() {
            let rows = BLOCK.min(ny - block * BLOCK);
            for (place, line) in tile.chunks_exact_mut(BLOCK).take(count).enumerate() {
                let at = place * ny + block * BLOCK;
                copy_rows(&guard.column[at..at + rows], line);
            }
        }
        energy
    }

    /// The same of one whose rows come in pieces.
    pub(super) fn pieces(&self, group: usize, pieces: &mut Pieces<T>) -> f64 {
        let guard = &mut *lock(self.scratch);
        let mut column = std::mem::take(&mut guard.column);
        for (rows, piece) in &*pieces {
            let values = piece.chunks_exact(PAIR * rows.len());
            for (values, line) in values.zip(column.chunks_exact_mut(self.ny)) {
                take_up(values, &mut line[rows.clone()]);
            }
        }
        let energy = self.convolve(group, &mut column, guard);
        for (rows, piece) in pieces {
            let values = piece.chunks_exact_mut(PAIR * rows.len());
            for (values, line) in values.zip(column.chunks_exact(self.ny)) {
                lay(&line[rows.clone()], values);
            }
        }
        guard.column = column;
        energy
    }

    /// Transforms the columns of a group, multiplies them and transforms them back; returns their energy.
    fn convolve(&self, group: usize, lines: &mut [Complex<T>], scratch: &mut Scratch<T>) -> f64 {
        let ny = self.ny;
        let half = ny / 2 + 1;
        let first = group * BLOCK;
        let count = BLOCK.min(self.columns - first);
        let mut energy = 0.0;
        for place in 0..count {
            let kx = first + place;
            let column = &mut lines[place * ny..(place + 1) * ny];
            self.forward
                .process_with_scratch(column, &mut scratch.transform);
            // Factors of both signs of ky.
            let at = (kx - self.first) * half;
            let factors = &self.factors[at..at + half];
            let (low, high) = scratch.factors.split_at_mut(half);
            for (to, &factor) in low.iter_mut().zip(factors) {
                *to = factor * self.scale;
            }
            for (to, &factor) in high.iter_mut().rev().zip(&factors[1..]) {
                *to = factor * self.scale;
            }
            let sum = Arch::new().dispatch(Scaling {
                column: &mut *column,
                factors: &scratch.factors,
                energy: self.energy,
            });
            // A half spectrum stands for both signs of kx, but for the two that are their own.
            let own = kx == 0 || (self.nx.is_multiple_of(2) && kx == self.nx / 2);
            energy += if own { sum } else { 2.0 * sum };
            self.backward
                .process_with_scratch(column, &mut scratch.transform);
        }
        energy
    }
}

/// Values of a column that are worked on side by side.
const LANES: usize = 16;

/// A column times its factors.
struct Scaling<'a, T> {
    column: &'a mut [Complex<T>],
    factors: &'a [T],
    energy: bool,
}

impl<T: Real> WithSimd for Scaling<'_, T> {
    /// The sum of `factor |value|^2` before, if it is asked for.
    type Output = f64;

    /// The same source for each kind of processor; the order of all additions is that of the lanes.
    #[allow(
        clippy::needless_range_loop,
        reason = "a pair of iterators over few lanes costs as much as they"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let mut sums = [0.0; LANES];
        let (columns, column_rest) = self.column.as_chunks_mut::<LANES>();
        let (factors, factor_rest) = self.factors.as_chunks::<LANES>();
        for (values, factors) in columns.iter_mut().zip(factors) {
            if self.energy {
                for lane in 0..LANES {
                    sums[lane] += (values[lane].norm_sqr() * factors[lane]).double();
                }
            }
            for lane in 0..LANES {
                values[lane] = values[lane].scale(factors[lane]);
            }
        }
        for (lane, (value, &factor)) in column_rest.iter_mut().zip(factor_rest).enumerate() {
            if self.energy {
                sums[lane] += (value.norm_sqr() * factor).double();
            }
            *value = value.scale(factor);
        }
        sums.iter().sum()
    }
}
