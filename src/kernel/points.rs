//! Kernels that look at one point at a time, run over several points side by side.
//!
//! A processor does the same to several numbers with one instruction, if it finds them next to each
//! other and nothing between them depends on the order. So the points of a block go through a kernel
//! in groups: their numbers are gathered, the kernel says what becomes of each, and what they add to
//! the sums is kept apart for each eighth place in a group until the block ends. The order of all additions
//! follows from the numbers of points and places alone, so that results are the same bits whatever a processor can do
//! at once.

use std::marker::PhantomData;
use std::ops::Range;

use pulp::{Arch, Simd, WithSimd};

use super::constraint::GapConstraint;
use super::seek::{SOUGHT, gap_at};
use super::{Params, Reduce, Rows, SUMS, Scalars, TRIED};
use crate::law::{AdhesionMap, Cohesion, HardWall, LawField};
use crate::real::Real;

/// Points in a group: a few of the widest vectors, so that what is done once a group costs little.
const LANES: usize = 32;
/// Places in which what the groups add to a sum is kept apart, so that vectors are added.
const PLACES: usize = 8;

/// One number a point of a group.
type Lanes<T> = [T; LANES];
/// What is kept of a sum or an extreme while a block goes.
type Places<T> = [T; PLACES];

/// The constraint of the gap and the numbers of a solve as it stands, in the kernel's number: what `params`
/// and `scalars` are to a shader.
#[derive(Clone, Copy, Default)]
pub struct Numbers<T, C> {
    pub constraint: C,
    pub stiffness_max: T,
    pub softening: T,
    pub offset: T,
    pub mean_pressure: T,
    pub descent_factor: T,
    pub beta: T,
    pub mean_gap_shift: T,
    pub trial_length: T,
    pub mean_gap_correction: T,
    pub step: T,
    pub snap: T,
    pub tried: [T; TRIED],
    pub accepted: bool,
}

impl<T: Real, C: GapConstraint<T>> Numbers<T, C> {
    fn new(params: &Params, scalars: &Scalars) -> Self {
        let mut tried = [T::zero(); TRIED];
        for (to, from) in tried.iter_mut().zip(scalars.tried) {
            *to = T::from_double(from);
        }
        Numbers {
            constraint: C::new(params),
            stiffness_max: T::from_double(params.stiffness_max),
            softening: T::from_double(params.softening),
            offset: T::from_double(scalars.offset),
            mean_pressure: T::from_double(scalars.mean_pressure),
            descent_factor: T::from_double(scalars.descent_factor),
            beta: T::from_double(scalars.beta),
            mean_gap_shift: T::from_double(scalars.mean_gap_shift),
            trial_length: T::from_double(scalars.trial_length),
            mean_gap_correction: T::from_double(scalars.mean_gap_correction),
            step: T::from_double(scalars.step),
            snap: T::from_double(scalars.snap),
            tried,
            accepted: scalars.accepted,
        }
    }
}

/// A point with its values, of which a kernel changes what it writes.
#[derive(Clone, Copy)]
pub struct Point<T, const READS: usize, const WRITES: usize, const TERMS: usize> {
    /// The fields that the kernel reads.
    pub reads: [T; READS],
    /// The fields that it writes, as they were.
    pub writes: [T; WRITES],
    /// The line of a transform, or the one that was kept.
    pub line: T,
    /// Whether the point is of the surface; else it is of the pad.
    pub in_domain: bool,
    /// The gap that was found for the kernel's goal, of a kernel that seeks one.
    pub found: T,
    /// What it adds to each sum, zero at first: in the kernel's number, so that all numbers of a group have the
    /// same width, and those in single precision go twice as many at a time. They are summed in double.
    pub terms: [T; TERMS],
}

/// A kernel that looks at one point at a time.
///
/// What it does at a point is always inlined, and it chooses between values rather than between ways, so
/// that a processor may do it at several points at once.
pub trait PointKernel<T: Real, C, const READS: usize, const WRITES: usize, const TERMS: usize> {
    /// Whether it leaves a pad as it is and adds nothing there.
    const SURFACE_ALONE: bool = false;

    /// Whether it needs the gap at a value of the iteration's variable, which takes repetitions: a group makes
    /// them together, before the kernel looks at each of its points.
    const SEEKS: bool = false;

    /// The value of the iteration's variable for which the gap is sought.
    #[inline(always)]
    fn goal(_: &Numbers<T, C>, _: &impl Cohesion<T>, _: &Point<T, READS, WRITES, TERMS>) -> T {
        T::zero()
    }

    /// What becomes of a point.
    fn at(
        numbers: &Numbers<T, C>,
        law: &impl Cohesion<T>,
        point: &mut Point<T, READS, WRITES, TERMS>,
    );
}

/// The twin that is made of such a kernel, over a constraint.
pub fn each_point<T, C, K, const READS: usize, const WRITES: usize, const TERMS: usize>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) where
    T: Real,
    C: GapConstraint<T>,
    K: PointKernel<T, C, READS, WRITES, TERMS>,
{
    C::run::<K, READS, WRITES, TERMS>(Numbers::new(params, scalars), params, rows, sums);
}

/// The same of a kernel that asks for no law.
pub fn each_point_without_law<
    T,
    C,
    K,
    const READS: usize,
    const WRITES: usize,
    const TERMS: usize,
>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) where
    T: Real,
    C: GapConstraint<T>,
    K: PointKernel<T, C, READS, WRITES, TERMS>,
{
    let numbers = Numbers::<T, C>::new(params, scalars);
    side_by_side::<T, C, K, READS, WRITES, TERMS>(numbers, AdhesionMap(HardWall), rows, sums);
}

/// Runs a kernel over several points side by side, with the best that the processor has.
pub(super) fn side_by_side<T, C, K, const READS: usize, const WRITES: usize, const TERMS: usize>(
    numbers: Numbers<T, C>,
    law: impl LawField<T>,
    rows: &mut Rows<T>,
    sums: &mut [f64; SUMS],
) where
    T: Real,
    C: GapConstraint<T>,
    K: PointKernel<T, C, READS, WRITES, TERMS>,
{
    let kernel = PhantomData::<K>;
    Arch::new().dispatch(Walk::<_, _, _, _, READS, WRITES, TERMS> {
        kernel,
        numbers,
        law,
        rows,
        sums,
    });
}

/// A kernel's walk over the points of some rows.
struct Walk<'a, 'b, T, C, K, L, const READS: usize, const WRITES: usize, const TERMS: usize> {
    kernel: PhantomData<K>,
    numbers: Numbers<T, C>,
    law: L,
    rows: &'a mut Rows<'b, T>,
    sums: &'a mut [f64; SUMS],
}

impl<T, C, K, L, const READS: usize, const WRITES: usize, const TERMS: usize> WithSimd
    for Walk<'_, '_, T, C, K, L, READS, WRITES, TERMS>
where
    T: Real,
    C: GapConstraint<T>,
    K: PointKernel<T, C, READS, WRITES, TERMS>,
    L: LawField<T>,
{
    type Output = ();

    /// The same source for each kind of processor; the compiler finds the vectors.
    #[allow(
        clippy::needless_range_loop,
        reason = "iterators and closures would be compiled with each kernel, law and number"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (numbers, law, rows, sums) = (self.numbers, self.law, self.rows, self.sums);
        let reduces = &rows.reduces[..TERMS];
        let mut totals = [[0.0; PLACES]; TERMS];
        // The least and the largest are exact in the kernel's own number.
        let mut extremes = [[T::zero(); PLACES]; TERMS];
        for slot in 0..TERMS {
            extremes[slot] = [T::from_double(reduces[slot].neutral()); PLACES];
        }
        let mut group = Group {
            reads: [[T::zero(); LANES]; READS],
            writes: [[T::zero(); LANES]; WRITES],
            line: [T::zero(); LANES],
            factor: [T::one(); LANES],
            outer_gap: [T::zero(); LANES],
            found: [T::zero(); LANES],
            terms: [[T::zero(); LANES]; TERMS],
        };
        for (points, in_domain) in rows.layout().runs() {
            if K::SURFACE_ALONE && !in_domain {
                continue;
            }
            for start in points.clone().step_by(LANES) {
                let here = start..points.end.min(start + LANES);
                group.gather(rows, &here);
                if K::SEEKS && in_domain {
                    group.seek::<C, K, L>(&numbers, &law);
                }
                group.work::<C, K, L>(&numbers, &law, in_domain);
                group.scatter(rows, &here);
                for slot in 0..TERMS {
                    let (total, extreme) = (&mut totals[slot], &mut extremes[slot]);
                    let terms = &group.terms[slot];
                    if here.len() < LANES {
                        join(total, extreme, &terms[..here.len()], reduces[slot]);
                    } else {
                        join_all(total, extreme, terms, reduces[slot]);
                    }
                }
            }
        }
        for slot in 0..TERMS {
            sums[slot] = joined(sums[slot], &totals[slot], &extremes[slot], reduces[slot]);
        }
    }
}

/// Puts what a full group adds to a sum to what its places hold already.
#[inline(always)]
fn join_all<T: Real>(
    total: &mut Places<f64>,
    extreme: &mut Places<T>,
    terms: &Lanes<T>,
    reduce: Reduce,
) {
    match reduce {
        Reduce::Add => {
            let at = |lane: usize| terms[lane].double();
            for (place, total) in total.iter_mut().enumerate() {
                let first = at(place) + at(place + PLACES);
                *total += first + (at(place + 2 * PLACES) + at(place + 3 * PLACES));
            }
        }
        Reduce::Min => {
            for lane in 0..LANES {
                let least = &mut extreme[lane % PLACES];
                *least = least.least(terms[lane]);
            }
        }
        Reduce::Max => {
            for lane in 0..LANES {
                let most = &mut extreme[lane % PLACES];
                *most = most.most(terms[lane]);
            }
        }
    }
}

// What follows is compiled once, and not with each kernel, law and number: it runs once a block, or where a
// group is not full.

/// The same of a group that is not full.
#[inline(never)]
fn join<T: Real>(total: &mut Places<f64>, extreme: &mut Places<T>, terms: &[T], reduce: Reduce) {
    for (lane, &term) in terms.iter().enumerate() {
        let (total, extreme) = (&mut total[lane % PLACES], &mut extreme[lane % PLACES]);
        match reduce {
            Reduce::Add => *total += term.double(),
            Reduce::Min => *extreme = extreme.least(term),
            Reduce::Max => *extreme = extreme.most(term),
        }
    }
}

/// A sum with what its places hold.
#[inline(never)]
fn joined<T: Real>(sum: f64, total: &Places<f64>, extreme: &Places<T>, reduce: Reduce) -> f64 {
    if reduce == Reduce::Add {
        total.iter().fold(sum, |sum, &place| sum + place)
    } else {
        let places = extreme.iter().map(|place| place.double());
        places.fold(sum, |sum, place| reduce.join(sum, place))
    }
}

/// The numbers of a group of points.
struct Group<T, const READS: usize, const WRITES: usize, const TERMS: usize> {
    reads: [Lanes<T>; READS],
    writes: [Lanes<T>; WRITES],
    line: Lanes<T>,
    factor: Lanes<T>,
    outer_gap: Lanes<T>,
    found: Lanes<T>,
    terms: [Lanes<T>; TERMS],
}

impl<T: Real, const READS: usize, const WRITES: usize, const TERMS: usize>
    Group<T, READS, WRITES, TERMS>
{
    #[inline(always)]
    fn gather(&mut self, rows: &Rows<T>, here: &Range<usize>) {
        for place in 0..READS {
            load(&mut self.reads[place], rows.reads[place], here);
        }
        for place in 0..WRITES {
            load(&mut self.writes[place], rows.writes[place], here);
        }
        load(&mut self.line, rows.lines, here);
        load(&mut self.factor, rows.factor, here);
        load(&mut self.outer_gap, rows.outer_gap, here);
    }

    /// The law at a point.
    #[inline(always)]
    fn law<L: LawField<T>>(&self, law: &L, lane: usize) -> L::Here {
        law.here(self.factor[lane], self.outer_gap[lane])
    }

    /// A point as its numbers are.
    #[allow(
        clippy::needless_range_loop,
        reason = "iterators and closures would be compiled with each kernel, law and number"
    )]
    #[inline(always)]
    fn point(&self, lane: usize, in_domain: bool) -> Point<T, READS, WRITES, TERMS> {
        let (mut reads, mut writes) = ([T::zero(); READS], [T::zero(); WRITES]);
        for place in 0..READS {
            reads[place] = self.reads[place][lane];
        }
        for place in 0..WRITES {
            writes[place] = self.writes[place][lane];
        }
        Point {
            reads,
            writes,
            line: self.line[lane],
            in_domain,
            found: self.found[lane],
            terms: [T::zero(); TERMS],
        }
    }

    /// Finds the gap at each point's goal.
    #[allow(
        clippy::needless_range_loop,
        reason = "iterators and closures would be compiled with each kernel, law and number"
    )]
    #[inline(always)]
    fn seek<C, K, L>(&mut self, numbers: &Numbers<T, C>, law: &L)
    where
        C: GapConstraint<T>,
        K: PointKernel<T, C, READS, WRITES, TERMS>,
        L: LawField<T>,
    {
        for lane in 0..LANES {
            self.found[lane] = K::goal(numbers, &self.law(law, lane), &self.point(lane, true));
        }
        let (gaps, _) = self.reads[0].as_chunks::<SOUGHT>();
        let (found, _) = self.found.as_chunks_mut::<SOUGHT>();
        for (part, (gaps, found)) in gaps.iter().zip(found).enumerate() {
            let laws = |place: usize| {
                let lane = part * SOUGHT + place;
                law.here(self.factor[lane], self.outer_gap[lane])
            };
            gap_at(&numbers.constraint, laws, gaps, found);
        }
    }

    /// Places without a point work on what they held before; nothing of them is kept.
    #[allow(
        clippy::needless_range_loop,
        reason = "iterators and closures would be compiled with each kernel, law and number"
    )]
    #[inline(always)]
    fn work<C, K, L>(&mut self, numbers: &Numbers<T, C>, law: &L, in_domain: bool)
    where
        K: PointKernel<T, C, READS, WRITES, TERMS>,
        L: LawField<T>,
    {
        for lane in 0..LANES {
            let law = self.law(law, lane);
            let mut point = self.point(lane, in_domain);
            K::at(numbers, &law, &mut point);
            for place in 0..WRITES {
                self.writes[place][lane] = point.writes[place];
            }
            self.line[lane] = point.line;
            for slot in 0..TERMS {
                self.terms[slot][lane] = point.terms[slot];
            }
        }
    }

    #[inline(always)]
    fn scatter(&self, rows: &mut Rows<T>, here: &Range<usize>) {
        for place in 0..WRITES {
            store(rows.writes[place], &self.writes[place], here);
        }
        store(rows.lines, &self.line, here);
    }
}

/// Takes a field's values; without a field all stays as it is.
#[inline(always)]
fn load<T: Real>(to: &mut Lanes<T>, field: &[T], here: &Range<usize>) {
    let Some(from) = field.get(here.clone()) else {
        return;
    };
    match <&Lanes<T>>::try_from(from) {
        Ok(all) => *to = *all,
        Err(_) => copy(&mut to[..from.len()], from),
    }
}

/// Copies the few points of a stretch's last group.
#[inline(never)]
fn copy<T: Real>(to: &mut [T], from: &[T]) {
    to.copy_from_slice(from);
}

/// Hands values to a field, if there is one.
#[inline(always)]
fn store<T: Real>(field: &mut [T], from: &Lanes<T>, here: &Range<usize>) {
    let Some(to) = field.get_mut(here.clone()) else {
        return;
    };
    match <&mut Lanes<T>>::try_from(&mut *to) {
        Ok(all) => *all = *from,
        Err(_) => copy(to, &from[..here.len()]),
    }
}

#[cfg(test)]
#[path = "points_tests.rs"]
mod tests;
