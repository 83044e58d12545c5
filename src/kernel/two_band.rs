//! Kernels of the two-band preconditioner: long waves are corrected on a coarse grid, where the
//! share of free points weighs them, so that they do not reach across contacts. Together they are
//! `plain::precondition`.

use super::constraint::Unilateral;
use super::descent::{DescentSums, MeanGapDescentSums, descent_terms, mean_gap_descent_terms};
use super::points::{Numbers, Point, PointKernel, each_point_without_law};
use crate::kernel::{Kernel, Params, Rows, SUMS, Scalars, rows_kernel};
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
fn coarsen<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
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

/// Restricts the projected residual of the fine level, and the share of free points there.
pub static COARSEN: Kernel = rows_kernel!(
    coarsen, Sweep, gate Ahead, law false,
    reads [], writes [restricted, share], fresh 2, whole true
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

fn weigh<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let restricted = rows.reads[0];
    let weight = &mut *rows.writes[0];
    for (i, line) in rows.lines.iter_mut().enumerate() {
        let m = line.max(T::zero()).min(T::one());
        weight[i] = m * m;
        *line = restricted[i] * weight[i];
    }
}

/// Takes the smoothed share of free points, stores its square, clipped to [0, 1], as the weight,
/// and fills the rows of a transform with the restricted residual times it.
pub static WEIGH: Kernel = rows_kernel!(
    weigh, InverseThenForward, gate Ahead, law false,
    reads [restricted], writes [weight], fresh 1
);

fn store_weighted<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let weight = rows.reads[0];
    let lines = &*rows.lines;
    for (i, out) in rows.writes[0].iter_mut().enumerate() {
        *out = weight[i] * lines[i];
    }
}

/// Stores the rows of a transform times the weight: the long-wave part of z.
pub static STORE_WEIGHTED: Kernel = rows_kernel!(
    store_weighted, Store, gate Ahead, law false,
    reads [weight], writes [long_waves], fresh 1
);

/// z on free points, which are those where the projected residual is not zero.
struct BandDescent<const MEAN_GAP: bool>;

impl<T: Real, C, const MEAN_GAP: bool, const READS: usize, const TERMS: usize>
    PointKernel<T, C, READS, 0, TERMS> for BandDescent<MEAN_GAP>
{
    #[inline(always)]
    fn at(_: &Numbers<T, C>, _: &impl Cohesion<T>, point: &mut Point<T, READS, 0, TERMS>) {
        let [residual, previous] = [point.reads[0], point.reads[1]];
        let free = residual != T::zero();
        let z = if free { point.line } else { T::zero() };
        descent_terms(z, residual, previous).put(&mut point.terms);
        if MEAN_GAP {
            let direction = point.reads[2];
            mean_gap_descent_terms([z, residual, previous, direction, T::one()], free)
                .put(&mut point.terms);
        }
        point.line = z;
    }
}

fn two_band_descent<T: Real, const MEAN_GAP: bool, const READS: usize, const TERMS: usize>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    add_interpolated(rows);
    each_point_without_law::<T, Unilateral<T>, BandDescent<MEAN_GAP>, READS, 0, TERMS>(
        rows, params, scalars, sums,
    );
}

/// Step 2, the end of `plain::precondition` with two bands: as `descent`, with the long waves added from the
/// coarse level.
pub static TWO_BAND_DESCENT: Kernel = rows_kernel!(
    two_band_descent [MEAN_GAP = false, 2, 2], RetainRows, gate Ahead, law false,
    reads [projected_residual, previous_residual], writes [], whole true,
    unbound [direction], sums [DescentSums]
);
/// The same under a prescribed mean gap.
pub static MEAN_GAP_TWO_BAND_DESCENT: Kernel = rows_kernel!(
    two_band_descent [MEAN_GAP = true, 3, 9], RetainRows, gate Ahead, law false,
    reads [projected_residual, previous_residual, direction], writes [], whole true,
    sums [DescentSums, MeanGapDescentSums]
);
