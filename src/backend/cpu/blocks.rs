//! Rows in blocks: the unit in which work is cut, summed and handed to threads.

use std::ops::Range;

use rustfft::num_complex::Complex;

use crate::backend::Shape;
use crate::kernel::{Params, Reduce, Rows, SUMS, Scalars, Twin, Whole};
use crate::real::Real;

/// Rows in a block; also the side of the tiles in which spectra are transposed. Eight complex
/// doubles are two cache lines, so a tile is read and written in whole lines.
pub(super) const BLOCK: usize = 8;
/// Values of a tile.
pub(super) const TILE: usize = BLOCK * BLOCK;

/// Spectra of eight rows at eight columns, column by column. Who works on rows has whole blocks of tiles for
/// itself; who works on columns has a group of tiles from each block.
pub(super) type Tile<T> = [Complex<T>; TILE];

/// The rows of a level that this process holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Held {
    /// The first one.
    pub first: usize,
    /// How many.
    pub count: usize,
}

/// A kernel over a range of blocks, with what it reads and the parts that it alone may write.
pub(super) struct Job<'a, T: Real> {
    /// Blocks of rows, counted from the first held one.
    pub blocks: Range<usize>,
    /// The level's shape.
    pub shape: Shape,
    /// Its rows that this process holds.
    pub held: Held,
    /// Fields read, all held rows.
    pub reads: [&'a [T]; 4],
    /// Fields written, cut to these blocks.
    pub writes: [&'a mut [T]; 4],
    /// The field read at rows of the kernel's own choice.
    pub whole: Whole<'a, T>,
    /// The field read around each point.
    pub around: Whole<'a, T>,
    /// Factors on the law's tension, all held rows; empty without them.
    pub factor: &'a [T],
    /// Gap of the outer state that is corrected, all held rows; empty without one.
    pub outer_gap: &'a [T],
    /// One set of sums a block.
    pub partials: &'a mut [[f64; SUMS]],
    /// Spectra of these blocks, `work_per_block` tiles each.
    pub work: &'a mut [Tile<T>],
    /// Tiles of one block's spectra.
    pub work_per_block: usize,
    /// Fixed numbers.
    pub params: &'a Params,
    /// Moving numbers.
    pub scalars: &'a Scalars,
    /// How its sums are put together.
    pub reduces: &'static [Reduce],
    /// What is done.
    pub twin: Twin<T>,
}

impl<'a, T: Real> Job<'a, T> {
    /// First row, counted from the first held one, and number of rows of a block.
    pub fn rows_of(&self, block: usize) -> (usize, usize) {
        let first = block * BLOCK;
        (first, BLOCK.min(self.held.count - first))
    }

    fn split(self, at: usize) -> (Job<'a, T>, Job<'a, T>) {
        let left_blocks = at - self.blocks.start;
        let rows = (at * BLOCK).min(self.held.count) - self.blocks.start * BLOCK;
        let values = rows * self.shape.points[0];
        let [a, b, c, d] = self.writes;
        let cut = |field: &'a mut [T]| {
            let at = values.min(field.len());
            field.split_at_mut(at)
        };
        let ((a0, a1), (b0, b1), (c0, c1), (d0, d1)) = (cut(a), cut(b), cut(c), cut(d));
        let (partials0, partials1) = self.partials.split_at_mut(left_blocks);
        let cut = (left_blocks * self.work_per_block).min(self.work.len());
        let (work0, work1) = self.work.split_at_mut(cut);
        let part = |blocks, writes, partials, work| Job {
            blocks,
            shape: self.shape,
            held: self.held,
            reads: self.reads,
            writes,
            whole: self.whole,
            around: self.around,
            factor: self.factor,
            outer_gap: self.outer_gap,
            partials,
            work,
            work_per_block: self.work_per_block,
            params: self.params,
            scalars: self.scalars,
            reduces: self.reduces,
            twin: self.twin,
        };
        (
            part(self.blocks.start..at, [a0, b0, c0, d0], partials0, work0),
            part(at..self.blocks.end, [a1, b1, c1, d1], partials1, work1),
        )
    }

    /// Runs the twin on the one block that is left, with these lines of a transform.
    pub fn call(&mut self, lines: &mut [T]) {
        let (first, count) = self.rows_of(self.blocks.start);
        let width = self.shape.points[0];
        let range = first * width..(first + count) * width;
        let mut reads: [&[T]; 4] = [&[]; 4];
        for (cut, field) in reads.iter_mut().zip(self.reads) {
            if !field.is_empty() {
                *cut = &field[range.clone()];
            }
        }
        let cut = |field: &'a [T]| -> &'a [T] {
            if field.is_empty() {
                &[]
            } else {
                &field[range.clone()]
            }
        };
        let (factor, outer_gap) = (cut(self.factor), cut(self.outer_gap));
        let [a, b, c, d] = &mut self.writes;
        let mut rows = Rows {
            first: self.held.first + first,
            width,
            count,
            surface: self.shape.surface,
            lines,
            reads,
            writes: [a, b, c, d],
            whole: self.whole,
            around: self.around,
            factor,
            outer_gap,
            reduces: self.reduces,
        };
        (self.twin)(&mut rows, self.params, self.scalars, &mut self.partials[0]);
    }
}

/// Halves a job until each part is one block, which `leaf` does; the halves run in parallel.
pub(super) fn run_blocks<T: Real>(job: Job<T>, leaf: &(impl Fn(Job<T>) + Sync)) {
    let count = job.blocks.len();
    if count <= 1 {
        if count == 1 {
            leaf(job);
        }
        return;
    }
    let middle = job.blocks.start + count / 2;
    let (left, right) = job.split(middle);
    rayon::join(|| run_blocks(left, leaf), || run_blocks(right, leaf));
}
