//! Kernels of the two-band preconditioner: long waves are corrected on a coarse grid, where the
//! share of free points weighs them, so that they do not reach across contacts.

use super::points::{Made, Point, PointKernel, each_point_without_law};
use super::wall::{descent_held_terms, descent_terms};
use crate::kernel::{Params, Rows, SUMS, Scalars, kernel};
use crate::law::Cohesion;
use crate::real::Real;

/// Largest number of fine points in a coarse cell along one axis.
const LARGEST_RATIO: usize = 4;

/// Share of the neighbouring cell in the value at place `place` of a cell of `ratio` points:
/// bilinear between cell centres. The neighbour is the cell before for the first half of the
/// places, the cell after for the second half.
fn neighbour_share(place: usize, ratio: usize) -> f64 {
    let from_centre = ((2 * place + 1) as f64 / (2 * ratio) as f64 - 0.5).abs();
    debug_assert!(from_centre < 0.5);
    from_centre
}

/// The cell before or after `cell` on a ring, for a place in the first or second half of `cell`.
fn neighbour(cell: usize, place: usize, ratio: usize, cells: usize) -> usize {
    if place < ratio / 2 {
        if cell == 0 { cells - 1 } else { cell - 1 }
    } else if cell + 1 == cells {
        0
    } else {
        cell + 1
    }
}

/// `neighbour_share` of each place.
fn shares<T: Real>(ratio: usize) -> [T; LARGEST_RATIO] {
    let mut shares = [T::zero(); LARGEST_RATIO];
    for (place, share) in shares.iter_mut().enumerate().take(ratio) {
        *share = T::of(neighbour_share(place, ratio));
    }
    shares
}

/// Adds the whole (coarse) field, interpolated, to the lines.
fn add_interpolated<T: Real>(rows: &mut Rows<T>) {
    let whole = rows.whole;
    let [cells, cell_rows] = whole.points;
    let (first, width) = (rows.first, rows.width);
    let ratio = width / cells;
    let shares = shares::<T>(ratio);
    for (row, line) in rows
        .lines
        .chunks_exact_mut(width)
        .take(rows.count)
        .enumerate()
    {
        let fine = first + row;
        let (cell, place) = (fine / ratio, fine % ratio);
        let other = neighbour(cell, place, ratio, cell_rows);
        let far = shares[place];
        let near = T::one() - far;
        let here = &whole.values[cell * cells..(cell + 1) * cells];
        let there = &whole.values[other * cells..(other + 1) * cells];
        let blend = |x: usize| near * here[x] + far * there[x];
        let mut before = blend(cells - 1);
        let mut present = blend(0);
        for (x, chunk) in line.chunks_exact_mut(ratio).enumerate() {
            let after = blend(if x + 1 == cells { 0 } else { x + 1 });
            let (left, right) = chunk.split_at_mut(ratio / 2);
            for (value, share) in left.iter_mut().zip(shares) {
                *value += present + share * (before - present);
            }
            for (value, &share) in right.iter_mut().zip(&shares[ratio / 2..]) {
                *value += present + share * (after - present);
            }
            before = present;
            present = after;
        }
    }
}

/// The transpose of the interpolation, over the number of fine points in a coarse cell.
fn coarse_restrict<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let whole = rows.whole;
    let [fine_x, fine_y] = whole.points;
    let (width, first, count) = (rows.width, rows.first, rows.count);
    let ratio = fine_x / width;
    let half = ratio / 2;
    let shares = shares::<T>(ratio);
    let scale = T::one() / T::of((ratio * ratio) as f64);
    let (restricted, rest) = rows.writes.split_at_mut(1);
    let (restricted, share) = (&mut *restricted[0], &mut *rest[0]);
    for row in 0..count {
        let out = &mut restricted[row * width..(row + 1) * width];
        let free = &mut share[row * width..(row + 1) * width];
        out.fill(T::zero());
        free.fill(T::zero());
        // This cell's own rows, and the nearer halves of the cells before and after.
        let start = (first + row) * ratio + fine_y - half;
        for offset in 0..2 * ratio {
            let fine = (start + offset) % fine_y;
            let line = &whole.values[fine * fine_x..(fine + 1) * fine_x];
            let far = shares[fine % ratio];
            let own = offset >= half && offset < half + ratio;
            let weight = scale * if own { T::one() - far } else { far };
            gather(out, line, &shares[..ratio], weight);
            if own {
                for (free, chunk) in free.iter_mut().zip(line.chunks_exact(ratio)) {
                    for &value in chunk {
                        if value != T::zero() {
                            *free += scale;
                        }
                    }
                }
            }
        }
    }
}
kernel!(
    /// Restricts the fine yF and the share of free points. Writes both; whole: the fine yF.
    COARSE_RESTRICT, coarse_restrict, Sweep, reads 0, writes 2, fresh 2, whole true, sums [], gate Ahead
);

/// Adds `weight` times the horizontal restriction of a fine line.
#[inline(always)]
fn gather<T: Real>(out: &mut [T], line: &[T], shares: &[T], weight: T) {
    let ratio = shares.len();
    let cells = out.len();
    let mut carried = T::zero();
    for (x, chunk) in line.chunks_exact(ratio).enumerate() {
        let (mut before, mut here, mut after) = (T::zero(), T::zero(), T::zero());
        for (place, (&value, &share)) in chunk.iter().zip(shares).enumerate() {
            let far = share * value;
            here += value - far;
            if place < ratio / 2 {
                before += far;
            } else {
                after += far;
            }
        }
        out[if x == 0 { cells - 1 } else { x - 1 }] += weight * before;
        out[x] += weight * (here + carried);
        carried = after;
    }
    out[0] += weight * carried;
}

fn coarse_weigh<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let restricted = rows.reads[0];
    let weight = &mut *rows.writes[0];
    for (i, line) in rows.lines.iter_mut().enumerate() {
        let m = line.max(T::zero()).min(T::one());
        weight[i] = m * m;
        *line = restricted[i] * weight[i];
    }
}
kernel!(
    /// Takes the smoothed share of free points, stores its square, clipped to [0, 1], as the weight,
    /// and loads the restricted yF times it.
    COARSE_WEIGH, coarse_weigh, Turn, reads 1, writes 1, fresh 1, whole false, sums [], gate Ahead
);

fn coarse_share<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let count = rows.len();
    rows.lines[..count].copy_from_slice(&rows.reads[0][..count]);
}
kernel!(
    /// Loads the share of free points.
    COARSE_SHARE, coarse_share, Load, reads 1, writes 0, whole false, sums [], gate Ahead
);

fn coarse_store<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let weight = rows.reads[0];
    let lines = &*rows.lines;
    for (i, out) in rows.writes[0].iter_mut().enumerate() {
        *out = weight[i] * lines[i];
    }
}
kernel!(
    /// Stores the lines times the weight: the long-wave part of z.
    COARSE_STORE, coarse_store, Store, reads 1, writes 1, fresh 1, whole false, sums [], gate Ahead
);

/// z on free points, which are those where yF is not zero.
#[derive(Clone, Copy)]
struct BandDescent;

impl<T: Real> PointKernel<T, 2, 0, 2> for BandDescent {
    #[inline(always)]
    fn of(_: &Params, _: &Scalars) -> Self {
        BandDescent
    }

    #[inline(always)]
    fn at(&self, _: &impl Cohesion<T>, point: Point<T, 2, 0>) -> Made<T, 0, 2> {
        let [y, y_before] = point.reads;
        let z = if y != T::zero() {
            point.line
        } else {
            T::zero()
        };
        Made {
            writes: [],
            line: z,
            terms: descent_terms(z, y, y_before),
        }
    }
}

impl<T: Real> PointKernel<T, 3, 0, 9> for BandDescent {
    #[inline(always)]
    fn of(_: &Params, _: &Scalars) -> Self {
        BandDescent
    }

    #[inline(always)]
    fn at(&self, _: &impl Cohesion<T>, point: Point<T, 3, 0>) -> Made<T, 0, 9> {
        let [y, y_before, direction] = point.reads;
        let free = y != T::zero();
        let z = if free { point.line } else { T::zero() };
        Made {
            writes: [],
            line: z,
            terms: descent_held_terms([z, y, y_before, direction], free),
        }
    }
}

fn two_band_descent<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    add_interpolated(rows);
    each_point_without_law::<T, BandDescent, 2, 0, 2>(rows, params, scalars, sums);
}
kernel!(
    /// As `wall_descent`, with the long waves added from the coarse level. Reads yF, the old yF; whole:
    /// the coarse z.
    TWO_BAND_DESCENT, two_band_descent, Keep, reads 2, writes 0, whole true,
    sums [Add, Add], gate Ahead
);

fn two_band_descent_held<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    add_interpolated(rows);
    each_point_without_law::<T, BandDescent, 3, 0, 9>(rows, params, scalars, sums);
}
kernel!(
    /// The same where the mean gap is held. Reads yF, the old yF, direction; whole: the coarse z.
    TWO_BAND_DESCENT_HELD, two_band_descent_held, Keep, reads 3, writes 0, whole true,
    sums [Add, Add, Add, Add, Add, Add, Add, Add, Add], gate Ahead
);
