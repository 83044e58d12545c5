//! Kernels of the multilevel preconditioner: each level answers the waves that the next one cannot hold by a
//! compliance of its own, and the coarsest one all others, weighed by the share of free points there, so that
//! they do not reach across contacts. Together they are `plain::precondition`.
//!
//! A residual is scaled as it is restricted, so that the compliance of a level is the same number on all of them.

use super::constraint::{GapConstraint, HardnessLimit, Unilateral};
use super::descent::{Descent, DescentSums, MeanGapDescentSums};
use super::points::{PointKernel, each_point};
use super::smooth::Smooth;
use crate::kernel::{
    Constraint, Kernel, Params, Rows, SUMS, Scalars, Whole, catalogue_entry, rows_kernel,
};
use crate::real::Real;

/// Largest number of finer points in a cell along one axis.
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
        *share = T::from_double(neighbour_share(place, ratio));
    }
    shares
}

/// Adds a whole coarser field, interpolated, to lines of so many points, `first` that of the first row.
fn add_interpolated<T: Real>(lines: &mut [T], whole: Whole<T>, width: usize, first: usize) {
    let [cells, cell_rows] = whole.points;
    let ratio = width / cells;
    let shares = shares::<T>(ratio);
    for (row, line) in lines.chunks_exact_mut(width).enumerate() {
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

/// The transpose of the interpolation, over the number of finer points along a cell: a mean would be over
/// their square, and the compliance of a level is in proportion to the length of its cells.
fn coarsen<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let whole = rows.whole;
    let [fine_x, fine_y] = whole.points;
    let (width, first) = (rows.width, rows.first);
    let ratio = fine_x / width;
    let half = ratio / 2;
    let shares = shares::<T>(ratio);
    let scale = T::one() / T::from_double(ratio as f64);
    let restricted = &mut rows.writes[0][..width * rows.count];
    for (row, out) in restricted.chunks_exact_mut(width).enumerate() {
        out.fill(T::zero());
        // This cell's own rows, and the nearer halves of the cells before and after.
        let start = (first + row) * ratio + fine_y - half;
        for offset in 0..2 * ratio {
            let fine = (start + offset) % fine_y;
            let line = &whole.values[fine * fine_x..(fine + 1) * fine_x];
            let far = shares[fine % ratio];
            let own = offset >= half && offset < half + ratio;
            let weight = scale * if own { T::one() - far } else { far };
            gather(out, line, &shares[..ratio], weight);
        }
    }
}

/// Restricts the projected residual of a level to the next coarser one.
pub static COARSEN: Kernel = rows_kernel!(
    coarsen, Sweep, gate Ahead, law false,
    reads [], writes [restricted], fresh 1, whole true
);

fn free_share<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let whole = rows.whole;
    let [fine_x, fine_y] = whole.points;
    let (width, first) = (rows.width, rows.first);
    let ratio = fine_x / width;
    debug_assert_eq!(fine_y % ratio, 0);
    let scale = T::one() / T::from_double((ratio * ratio) as f64);
    let share = &mut rows.writes[0][..width * rows.count];
    for (row, out) in share.chunks_exact_mut(width).enumerate() {
        out.fill(T::zero());
        let start = (first + row) * ratio;
        for line in whole.values[start * fine_x..(start + ratio) * fine_x].chunks_exact(fine_x) {
            for (free, chunk) in out.iter_mut().zip(line.chunks_exact(ratio)) {
                let count = chunk.iter().filter(|value| **value != T::zero()).count();
                *free += scale * T::from_double(count as f64);
            }
        }
    }
}

/// The share of free points of the fine level in each cell: those where the projected residual is not zero.
pub static FREE_SHARE: Kernel = rows_kernel!(
    free_share, Sweep, gate Ahead, law false,
    reads [], writes [share], fresh 1, whole true
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
        weight[i] = m * m * m;
        *line = restricted[i] * weight[i];
    }
}

/// Takes the smoothed share of free points, stores its cube, clipped to [0, 1], as the weight,
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

/// Stores the rows of a transform times the weight: z of the coarsest level.
pub static STORE_WEIGHTED: Kernel = rows_kernel!(
    store_weighted, Store, gate Ahead, law false,
    reads [weight], writes [coarsest_z], fresh 1
);

fn refine<T: Real>(rows: &mut Rows<T>, params: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let compliance = T::from_double(params.level_compliance);
    let (whole, width, first) = (rows.whole, rows.width, rows.first);
    let z = &mut rows.writes[0][..width * rows.count];
    z.iter_mut().for_each(|z| *z = compliance * *z);
    add_interpolated(z, whole, width, first);
}

/// z of a level in the place of the restricted residual: the level's own compliance of it, and z of the next
/// coarser level interpolated.
pub static REFINE: Kernel = rows_kernel!(
    refine, Sweep, gate Ahead, law false,
    reads [], writes [restricted], whole true
);

fn level_descent<T, C, const MEAN_GAP: bool, const READS: usize, const TERMS: usize>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) where
    T: Real,
    C: GapConstraint<T>,
    Descent<MEAN_GAP, true>: PointKernel<T, C, READS, 0, TERMS>,
{
    let (whole, width, first) = (rows.whole, rows.width, rows.first);
    let lines = &mut rows.lines[..width * rows.count];
    lines.fill(T::zero());
    add_interpolated(lines, whole, width, first);
    each_point::<T, C, Descent<MEAN_GAP, true>, READS, 0, TERMS>(rows, params, scalars, sums);
}

/// The variants of the end of the preconditioner for each constraint.
macro_rules! level_descents {
    ($(#[$doc:meta])* $constant:ident [MEAN_GAP = $set:literal], $($rest:tt)*) => {
        $(#[$doc])*
        pub static $constant: [Kernel; 3] = [
            level_descents!(@over Unilateral, $set, $($rest)*),
            level_descents!(@over HardnessLimit, $set, $($rest)*),
            level_descents!(@over Smooth, $set, $($rest)*),
        ];
    };
    (@over $constraint:ident, $set:literal, $($rest:tt)*) => {
        catalogue_entry!(
            level_descent, Retain, gate Ahead, law true,
            constraint Some(Constraint::$constraint), flag [MEAN_GAP = $set],
            twins [
                level_descent::<f64, $constraint<f64>, $set, READS, TERMS>,
                level_descent::<f32, $constraint<f32>, $set, READS, TERMS>
            ],
            $($rest)*
        )
    };
}

level_descents!(
    /// Step 2, the end of `plain::precondition` with levels: as `descent`, with z of the first coarser level
    /// interpolated and the finest level's own compliance. Retains the rows of z.
    LEVEL_DESCENT [MEAN_GAP = false],
    reads [gap, pressure, previous_residual], writes [], whole true, unbound [direction],
    sums [DescentSums]
);
level_descents!(
    /// The same under a prescribed mean gap.
    MEAN_GAP_LEVEL_DESCENT [MEAN_GAP = true],
    reads [gap, pressure, previous_residual, direction], writes [], whole true,
    sums [DescentSums, MeanGapDescentSums]
);
