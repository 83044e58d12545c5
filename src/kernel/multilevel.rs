//! Kernels of the multilevel preconditioner: each level answers the waves that the next one cannot hold by a
//! compliance of its own, and the coarsest one all others, weighed by the share of free points there, so that
//! they do not reach across contacts. Together they are `plain::precondition`.
//!
//! A residual is scaled as it is restricted, so that the compliance of a level is the same number on all of them.

use pulp::{Arch, Simd, WithSimd};

use super::constraint::{GapConstraint, HardnessLimit, Unilateral};
use super::descent::{Descent, DescentSums, MeanGapDescentSums, descent_terms};
use super::points::{Numbers, Point, PointKernel, each_point, each_point_without_law};
use super::smooth::Smooth;
use crate::kernel::{
    Constraint, Kernel, Params, Rows, SUMS, Scalars, Whole, catalogue_entry, rows_kernel,
};
use crate::law::Cohesion;
use crate::real::Real;

/// Finer points along a cell of the next level.
const RATIO: usize = 2;
/// [`neighbour_share`] of both points of a cell.
const NEIGHBOUR: f64 = neighbour_share(0, RATIO);
/// Cells that are worked on side by side.
const TILE: usize = 32;

/// The place before one on a ring.
#[inline(always)]
fn before(place: usize, places: usize) -> usize {
    if place == 0 { places - 1 } else { place - 1 }
}

/// The place after one on a ring.
#[inline(always)]
fn after(place: usize, places: usize) -> usize {
    if place + 1 == places { 0 } else { place + 1 }
}

/// Share of the neighbouring cell in the value at a place of a cell of `ratio` points: bilinear between cell
/// centres.
const fn neighbour_share(place: usize, ratio: usize) -> f64 {
    ((2 * place + 1) as f64 / (2 * ratio) as f64 - 0.5).abs()
}

/// The cell before or after `cell` on a ring, for a place in the first or second half of `cell`.
#[inline(always)]
fn neighbour(cell: usize, place: usize, ratio: usize, cells: usize) -> usize {
    if place < ratio / 2 {
        before(cell, cells)
    } else {
        after(cell, cells)
    }
}

/// A whole coarser field, interpolated to lines of so many points, `first` that of the first row: in their place,
/// or beside what a factor leaves of them.
struct Interpolation<'a, T, const ADDS: bool> {
    lines: &'a mut [T],
    whole: Whole<'a, T>,
    width: usize,
    first: usize,
    factor: T,
}

impl<T: Real, const ADDS: bool> WithSimd for Interpolation<'_, T, ADDS> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let [cells, cell_rows] = self.whole.points();
        debug_assert_eq!(self.width, RATIO * cells);
        let far = T::from_double(NEIGHBOUR);
        let near = T::one() - far;
        for (row, line) in self.lines.chunks_exact_mut(self.width).enumerate() {
            let fine = self.first + row;
            let cell = fine / RATIO;
            let other = neighbour(cell, fine % RATIO, RATIO, cell_rows);
            let here = self.whole.row(cell);
            let there = self.whole.row(other);
            let blend = |x: usize| near * here[x] + far * there[x];
            for (tile, out) in line.chunks_mut(RATIO * TILE).enumerate() {
                let start = tile * TILE;
                let count = out.len() / RATIO;
                // Those of the tile, between the ones beside it.
                let mut blended = [T::zero(); TILE + 2];
                blended[0] = blend(before(start, cells));
                blended[count + 1] = blend(after(start + count - 1, cells));
                let (here, there) = (&here[start..start + count], &there[start..start + count]);
                for (x, value) in blended[1..=count].iter_mut().enumerate() {
                    *value = near * here[x] + far * there[x];
                }
                let (pairs, _) = out.as_chunks_mut::<RATIO>();
                for (x, pair) in pairs.iter_mut().enumerate() {
                    let [left, own, right] = [blended[x], blended[x + 1], blended[x + 2]];
                    let values = [own + far * (left - own), own + far * (right - own)];
                    for side in 0..RATIO {
                        pair[side] = if ADDS {
                            self.factor * pair[side] + values[side]
                        } else {
                            values[side]
                        };
                    }
                }
            }
        }
    }
}

/// The transpose of the interpolation, over the number of finer points along a cell: a mean would be over
/// their square, and the compliance of a level is in proportion to the length of its cells.
struct Restriction<'a, T> {
    restricted: &'a mut [T],
    whole: Whole<'a, T>,
    width: usize,
    first: usize,
}

impl<T: Real> WithSimd for Restriction<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let [fine_x, fine_y] = self.whole.points();
        debug_assert_eq!(fine_x, RATIO * self.width);
        let far = T::from_double(NEIGHBOUR);
        let near = T::one() - far;
        let scale = T::one() / T::from_double(RATIO as f64);
        for (row, line) in self.restricted.chunks_exact_mut(self.width).enumerate() {
            // This cell's own rows, and the nearer ones of the cells before and after.
            let own = (self.first + row) * RATIO;
            let row = |y: usize| self.whole.row(y);
            let (a, b) = (row(before(own, fine_y)), row(own));
            let (c, d) = (row(own + 1), row(after(own + 1, fine_y)));
            let across = |x: usize| scale * (far * (a[x] + d[x]) + near * (b[x] + c[x]));
            for (tile, out) in line.chunks_mut(TILE).enumerate() {
                let start = RATIO * tile * TILE;
                let count = RATIO * out.len();
                // Those of the tile, between the ones beside it.
                let mut columns = [T::zero(); RATIO * TILE + 2];
                columns[0] = across(before(start, fine_x));
                columns[count + 1] = across(after(start + count - 1, fine_x));
                let end = start + count;
                let (a, b, c, d) = (
                    &a[start..end],
                    &b[start..end],
                    &c[start..end],
                    &d[start..end],
                );
                for (x, column) in columns[1..=count].iter_mut().enumerate() {
                    *column = scale * (far * (a[x] + d[x]) + near * (b[x] + c[x]));
                }
                for (x, value) in out.iter_mut().enumerate() {
                    let at = RATIO * x;
                    *value = near * (columns[at + 1] + columns[at + 2])
                        + far * (columns[at] + columns[at + 3]);
                }
            }
        }
    }
}

fn coarsen<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    Arch::new().dispatch(Restriction {
        restricted: &mut rows.writes[0][..rows.width * rows.count],
        whole: rows.whole,
        width: rows.width,
        first: rows.first,
    });
}

/// Restricts the projected residual of a level to the next coarser one.
pub static COARSEN: Kernel = rows_kernel!(
    coarsen, Sweep, gate Ahead, law false,
    reads [], writes [restricted], fresh 1, whole true
);

/// The share of values that are not zero in each cell of so many finer points each way.
struct FreeShare<'a, T> {
    share: &'a mut [T],
    whole: Whole<'a, T>,
    width: usize,
    first: usize,
}

/// Finer points of a row that are counted side by side, a multiple of those in any cell.
const COUNTED: usize = 64;

impl<T: Real> WithSimd for FreeShare<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let [fine_x, fine_y] = self.whole.points();
        let ratio = fine_x / self.width;
        debug_assert!(fine_y.is_multiple_of(ratio) && COUNTED.is_multiple_of(ratio));
        let scale = T::one() / T::from_double((ratio * ratio) as f64);
        for (row, line) in self.share.chunks_exact_mut(self.width).enumerate() {
            let start = (self.first + row) * ratio;
            let fine = self.whole.rows(start..start + ratio);
            for (tile, out) in line.chunks_mut(COUNTED / ratio).enumerate() {
                let columns = tile * COUNTED..tile * COUNTED + out.len() * ratio;
                let mut counts = [T::zero(); COUNTED];
                for line in fine.chunks_exact(fine_x) {
                    for (x, value) in line[columns.clone()].iter().enumerate() {
                        counts[x] += if *value == T::zero() {
                            T::zero()
                        } else {
                            T::one()
                        };
                    }
                }
                for (x, share) in out.iter_mut().enumerate() {
                    let mut sum = T::zero();
                    for count in &counts[x * ratio..(x + 1) * ratio] {
                        sum += *count;
                    }
                    *share = scale * sum;
                }
            }
        }
    }
}

fn free_share<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    Arch::new().dispatch(FreeShare {
        share: &mut rows.writes[0][..rows.width * rows.count],
        whole: rows.whole,
        width: rows.width,
        first: rows.first,
    });
}

/// The share of free points of the fine level in each cell: those where the projected residual is not zero.
pub static FREE_SHARE: Kernel = rows_kernel!(
    free_share, Sweep, gate Ahead, law false,
    reads [], writes [share], fresh 1, whole true
);

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

fn load_weighted<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let [restricted, weight, ..] = rows.reads;
    for (i, line) in rows.lines.iter_mut().enumerate() {
        *line = restricted[i] * weight[i];
    }
}

/// Fills the rows of a transform with the restricted residual times the weight that is there already: the second
/// sweep has the free points of the first.
pub static LOAD_WEIGHTED: Kernel = rows_kernel!(
    load_weighted, Load, gate Ahead, law false,
    reads [restricted, weight], writes []
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

/// Adds a whole coarser field, interpolated, to lines of so many points, `first` that of the first row, or takes it
/// in their place.
fn add_interpolated<T: Real, const ADDS: bool>(
    lines: &mut [T],
    whole: Whole<T>,
    [width, first]: [usize; 2],
    factor: T,
) {
    Arch::new().dispatch(Interpolation::<_, ADDS> {
        lines,
        whole,
        width,
        first,
        factor,
    });
}

fn refine<T: Real>(rows: &mut Rows<T>, params: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    add_interpolated::<T, true>(
        &mut rows.writes[0][..rows.width * rows.count],
        rows.whole,
        [rows.width, rows.first],
        T::from_double(params.level_compliance),
    );
}

/// z of a level in the place of the restricted residual: the level's own compliance of it, and z of the next
/// coarser level interpolated.
pub static REFINE: Kernel = rows_kernel!(
    refine, Sweep, gate Ahead, law false,
    reads [], writes [restricted], whole true
);

/// z at a wall, of the projected residual that the levels keep: a point is free where that is not zero.
struct WallLevelDescent;

impl<T: Real, C: GapConstraint<T>> PointKernel<T, C, 2, 0, 2> for WallLevelDescent {
    #[inline(always)]
    fn at(_: &Numbers<T, C>, _: &impl Cohesion<T>, point: &mut Point<T, 2, 0, 2>) {
        let [residual, previous] = point.reads;
        let z = if residual == T::zero() {
            T::zero()
        } else {
            point.line
        };
        descent_terms(z, residual, previous).put(&mut point.terms);
        point.line = z;
    }
}

fn wall_level_descent<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    finest_answer(rows, params);
    each_point_without_law::<T, Unilateral<T>, WallLevelDescent, 2, 0, 2>(
        rows, params, scalars, sums,
    );
}

fn level_descent<T, C, const MEAN_GAP: bool, const READS: usize, const TERMS: usize>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) where
    T: Real,
    C: GapConstraint<T>,
    Descent<MEAN_GAP>: PointKernel<T, C, READS, 0, TERMS>,
{
    finest_answer(rows, params);
    each_point::<T, C, Descent<MEAN_GAP>, READS, 0, TERMS>(rows, params, scalars, sums);
}

/// Fills the lines with what the levels answer each point with, before it is known whether the point is free.
fn finest_answer<T: Real>(rows: &mut Rows<T>, params: &Params) {
    let lines = &mut rows.lines[..rows.width * rows.count];
    let place = [rows.width, rows.first];
    add_interpolated::<T, false>(lines, rows.whole, place, T::zero());
    Arch::new().dispatch(Finest {
        lines,
        residual: rows.around,
        first: rows.first,
        own: T::from_double(params.own_compliance),
        beside: T::from_double(params.neighbour_compliance),
    });
}

/// Adds to lines what the finest level answers each point with, of the residual there and at its four neighbours.
struct Finest<'a, T> {
    lines: &'a mut [T],
    residual: Whole<'a, T>,
    first: usize,
    own: T,
    beside: T,
}

impl<T: Real> WithSimd for Finest<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let [width, rows] = self.residual.points();
        let (own_share, beside_share) = (self.own, self.beside);
        for (row, line) in self.lines.chunks_exact_mut(width).enumerate() {
            let here = self.first + row;
            let row = |y: usize| self.residual.row(y);
            let (above, own, below) = (row(before(here, rows)), row(here), row(after(here, rows)));
            let last = width - 1;
            let beside = [
                (0, own[last] + own[after(0, width)]),
                (last, own[before(last, width)] + own[0]),
            ];
            // A grid with levels has more than two points each way. Parts of one length are not asked for it at each point.
            let (inner, above_inner, below_inner) =
                (&mut line[1..last], &above[1..last], &below[1..last]);
            let (left, inner_own, right) = (&own[..last - 1], &own[1..last], &own[2..]);
            for x in 0..last - 1 {
                inner[x] +=
                    beside_share * ((above_inner[x] + below_inner[x]) + (left[x] + right[x]));
                inner[x] += own_share * inner_own[x];
            }
            for (x, along) in beside {
                line[x] += beside_share * ((above[x] + below[x]) + along);
                line[x] += own_share * own[x];
            }
        }
    }
}

/// The end of the preconditioner over a constraint, as a catalogue entry.
macro_rules! level_descent {
    ($constraint:ident, MEAN_GAP = $set:literal, $($rest:tt)*) => {
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
    ($constraint:ident without law, $($rest:tt)*) => {
        catalogue_entry!(
            level_descent, Retain, gate Ahead, law false,
            constraint Some(Constraint::$constraint), flag [MEAN_GAP = false],
            twins [wall_level_descent::<f64>, wall_level_descent::<f32>],
            reads [projected_residual, previous_residual], writes [], $($rest)*
        )
    };
}

/// Step 2, the end of `plain::precondition` with levels: as `descent`, with z of the first coarser level
/// interpolated and the finest level's own compliance of the residual that the levels answer, smoothed by its neighbours.
/// At a wall the projected residual says all, and asks for neither gap nor law. Retains the rows of z.
pub static LEVEL_DESCENT: [Kernel; 3] = [
    level_descent!(
        Unilateral without law, around answered_residual, whole true,
        unbound [gap, pressure, direction], sums [DescentSums]
    ),
    level_descent!(
        HardnessLimit without law, around answered_residual, whole true,
        unbound [gap, pressure, direction], sums [DescentSums]
    ),
    level_descent!(
        Smooth, MEAN_GAP = false,
        reads [gap, pressure, previous_residual], writes [], around answered_residual, whole true,
        unbound [projected_residual, direction], sums [DescentSums]
    ),
];

/// The same under a prescribed mean gap, over a constraint.
macro_rules! mean_gap_level_descent {
    ($constraint:ident) => {
        level_descent!(
            $constraint, MEAN_GAP = true,
            reads [gap, pressure, previous_residual, direction], writes [], around answered_residual,
            whole true, unbound [projected_residual], sums [DescentSums, MeanGapDescentSums]
        )
    };
}

/// The same under a prescribed mean gap.
pub static MEAN_GAP_LEVEL_DESCENT: [Kernel; 3] = [
    mean_gap_level_descent!(Unilateral),
    mean_gap_level_descent!(HardnessLimit),
    mean_gap_level_descent!(Smooth),
];

/// r + a D M r, of a line of M r: what an attraction that falls with the gap takes off the stiffness.
struct Soften;

impl<T: Real, C: GapConstraint<T>> PointKernel<T, C, 2, 0, 0> for Soften {
    #[inline(always)]
    fn at(numbers: &Numbers<T, C>, law: &impl Cohesion<T>, point: &mut Point<T, 2, 0, 0>) {
        let [gap, residual] = point.reads;
        // Where the solid yields, it does not feel the law's slope.
        let falls = point.in_domain & (residual != T::zero()) & (law.open(gap) >= T::zero());
        let softened = residual - numbers.softening * law.slope(gap) * point.line;
        point.line = if falls { softened } else { residual };
    }
}

fn soften<T: Real, C: GapConstraint<T>>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    finest_answer(rows, params);
    each_point::<T, C, Soften, 2, 0, 0>(rows, params, scalars, sums);
}

/// The variants of what begins a second sweep.
macro_rules! softens {
    ($constraint:ident) => {
        catalogue_entry!(
            soften, Retain, gate Ahead, law true, constraint Some(Constraint::$constraint), flag [],
            twins [soften::<f64, $constraint<f64>>, soften::<f32, $constraint<f32>>],
            reads [gap, projected_residual], writes [], around projected_residual, whole true
        )
    };
}

/// Step 2, the middle of `plain::precondition` where an attraction falls with the gap: of z of the first coarser level
/// it makes M r, and retains the rows of r + a D M r.
pub static SOFTEN: [Kernel; 2] = [softens!(Unilateral), softens!(HardnessLimit)];

fn store_retained<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    rows.writes[0].copy_from_slice(rows.lines);
}

/// Stores rows that were kept: the residual of the second sweep.
pub static STORE_RETAINED: Kernel = rows_kernel!(
    store_retained, ReadRetained, gate Ahead, law false,
    reads [], writes [field], fresh 1
);
