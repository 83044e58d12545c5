//! The part of a contact's fields that this process holds on the host, all rows or its rank's slab of them, and what
//! the ranks find out together of such fields.
//!
//! Every rank makes the same calls in the same order. A rank that is gone makes sums NaN, so that nothing converges,
//! and [`Share::failed`] says so.

mod columns;
mod rows;

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use rayon::prelude::*;

use super::cpu::Slabs;
use super::ranks::{Parts, RankError, Ranks};
use super::{BackendError, Shape};

/// The rank that writes the files.
const FIRST: usize = 0;

/// The rows of a shape that this process holds: all of them where it is alone.
#[derive(Clone, Debug)]
pub struct Share {
    shape: Shape,
    slabs: Option<Slabs>,
    /// A rank that has ended.
    failure: Arc<OnceLock<RankError>>,
}

impl Share {
    /// All rows.
    pub fn whole(shape: Shape) -> Share {
        Share::on_ranks(shape, None)
    }

    /// The rows of this rank, where there are several.
    pub fn on_ranks(shape: Shape, ranks: Option<Arc<dyn Ranks>>) -> Share {
        let several = ranks.filter(|ranks| ranks.count() > 1);
        Share {
            shape,
            slabs: several.map(|ranks| Slabs::of_blocks(ranks, shape.points[1])),
            failure: Arc::default(),
        }
    }

    /// The rows of another shape over the same ranks.
    pub fn of(&self, shape: Shape) -> Share {
        let slabs = self.slabs.as_ref();
        Share {
            shape,
            slabs: slabs.map(|slabs| slabs.of_level(shape.points[1])),
            failure: Arc::clone(&self.failure),
        }
    }

    /// The points of all ranks.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// Whether this process holds all rows.
    pub fn is_whole(&self) -> bool {
        self.slabs.is_none()
    }

    /// The processes, where there are several.
    pub fn ranks(&self) -> Option<&dyn Ranks> {
        self.slabs.as_ref().map(Slabs::ranks)
    }

    /// Whether this process writes the files.
    pub fn is_first(&self) -> bool {
        self.ranks().is_none_or(|ranks| ranks.rank() == FIRST)
    }

    /// How many processes there are.
    pub fn count(&self) -> usize {
        self.ranks().map_or(1, Ranks::count)
    }

    /// The number of this one, from 0.
    pub fn rank(&self) -> usize {
        self.ranks().map_or(0, Ranks::rank)
    }

    /// The rows of a rank.
    pub fn rows_of(&self, rank: usize) -> Range<usize> {
        match &self.slabs {
            None => 0..self.shape.points[1],
            Some(slabs) => slabs.rows_of(rank),
        }
    }

    /// The rows of this process.
    pub fn rows(&self) -> Range<usize> {
        self.rows_of(self.rank())
    }

    /// Those of the surface among the rows of a rank: the first of them.
    pub fn surface_rows_of(&self, rank: usize) -> Range<usize> {
        let (rows, last) = (self.rows_of(rank), self.shape.surface[1]);
        rows.start.min(last)..rows.end.min(last)
    }

    /// Those of this process.
    pub fn surface_rows(&self) -> Range<usize> {
        self.surface_rows_of(self.rank())
    }

    /// Points that this process holds.
    pub fn len(&self) -> usize {
        self.rows().len() * self.shape.points[0]
    }

    /// Whether it holds none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Surface points of all ranks along x and y.
    pub fn surface(&self) -> [usize; 2] {
        self.shape.surface
    }

    /// Surface points that it holds.
    pub fn surface_len(&self) -> usize {
        self.surface_rows().len() * self.shape.surface[0]
    }

    /// Whether every rank was there in all that was found out so far.
    ///
    /// # Errors
    /// One has ended.
    pub fn failed(&self) -> Result<(), BackendError> {
        match self.failure() {
            None => Ok(()),
            Some(error) => Err(BackendError::Device(error.to_string())),
        }
    }

    /// The rank that was missed, if one has ended.
    pub fn failure(&self) -> Option<RankError> {
        self.failure.get().copied()
    }

    fn noted<T>(&self, found: Result<T, RankError>) -> Option<T> {
        found
            .inspect_err(|error| {
                // The first one counts.
                let _ = self.failure.set(*error);
            })
            .ok()
    }

    /// Numbers of one rank, on all.
    fn told_by(&self, rank: usize, own: &mut [f64]) -> Result<(), RankError> {
        let Some(ranks) = self.ranks() else {
            return Ok(());
        };
        let bytes = size_of_val(own);
        let lengths: Vec<usize> = (0..ranks.count())
            .map(|other| if other == rank { bytes } else { 0 })
            .collect();
        let given = own.to_vec();
        let given: &[f64] = if ranks.rank() == rank { &given } else { &[] };
        let all = Parts {
            bytes: bytemuck::cast_slice_mut(own),
            lengths: &lengths,
        };
        ranks.gather(bytemuck::cast_slice(given), all)
    }

    /// The numbers of all ranks, one rank after another, of which each has so many.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn numbers(
        &self,
        own: &[f64],
        lengths: impl Iterator<Item = usize>,
    ) -> Result<Vec<f64>, BackendError> {
        let Some(slabs) = &self.slabs else {
            return Ok(own.to_vec());
        };
        let all = self.noted(slabs.gather_numbers(own, lengths));
        self.failed()?;
        Ok(all.unwrap_or_default())
    }

    /// The sum of one number for each surface row, in the order of the rows.
    pub fn sum_of_rows(&self, own: &[f64]) -> f64 {
        let lengths = (0..self.count()).map(|rank| self.surface_rows_of(rank).len());
        match self.numbers(own, lengths) {
            Ok(all) => all.iter().sum(),
            Err(_) => f64::NAN,
        }
    }

    /// Sums over the points of all ranks, of which this one has so many rows: `add` adds those of a row, counted from
    /// the first one here.
    pub fn sums<const N: usize>(
        &self,
        rows: usize,
        add: impl Fn(usize, &mut [f64; N]) + Sync,
    ) -> [f64; N] {
        self.sums_of_rows(&of_each_row(rows, &add))
    }

    /// The same where `change` makes other values of a row's part of three fields. Two have `width` points in a row. The third has
    /// `third_width`, and in rows beyond its last one its part is empty.
    pub fn sums_changing<P: Send, const N: usize>(
        &self,
        (width, [first, second]): (usize, [&mut [f64]; 2]),
        (third_width, third): (usize, &mut [P]),
        change: impl Fn(usize, [&mut [f64]; 2], &mut [P], &mut [f64; N]) + Sync,
    ) -> [f64; N] {
        let rows = first
            .par_chunks_mut(width)
            .zip(second.par_chunks_mut(width));
        let parts = third.par_chunks_mut(third_width);
        let beyond = (parts.len()..rows.len()).into_par_iter();
        let parts = parts.chain(beyond.map(|_| <&mut [P]>::default()));
        let of_row = |(row, ((first, second), third))| {
            let mut sums = [0.0; N];
            change(row, [first, second], third, &mut sums);
            sums
        };
        let own: Vec<_> = rows.zip(parts).enumerate().map(of_row).collect();
        self.sums_of_rows(&own)
    }

    /// The same of sums that are known of each row here, in the order of the rows: the same bits on any number of ranks and
    /// threads.
    fn sums_of_rows<const N: usize>(&self, own: &[[f64; N]]) -> [f64; N] {
        let mut sums = [0.0; N];
        for rank in 0..self.count() {
            if rank == self.rank() {
                for row in own {
                    sums.iter_mut().zip(row).for_each(|(sum, row)| *sum += row);
                }
            }
            if self.noted(self.told_by(rank, &mut sums)).is_none() {
                return [f64::NAN; N];
            }
        }
        sums
    }

    /// The sum of a field over all solved points.
    pub fn sum(&self, own: &[f64]) -> f64 {
        self.sum_by(own, |value| value)
    }

    /// The sum of a function of it.
    pub fn sum_by(&self, own: &[f64], of: impl Fn(f64) -> f64 + Sync) -> f64 {
        self.sum_in_lines(own, self.shape.points[0], of)
    }

    /// The same of a field over the surface.
    pub fn surface_sum_by(&self, own: &[f64], of: impl Fn(f64) -> f64 + Sync) -> f64 {
        self.sum_in_lines(own, self.shape.surface[0], of)
    }

    fn sum_in_lines(&self, own: &[f64], width: usize, of: impl Fn(f64) -> f64 + Sync) -> f64 {
        let [sum] = self.sums(own.len() / width, |row, [sum]| {
            for value in &own[row * width..(row + 1) * width] {
                *sum += of(*value);
            }
        });
        sum
    }

    /// The sum of the products of two fields over all solved points.
    pub fn product(&self, a: &[f64], b: &[f64]) -> f64 {
        let width = self.shape.points[0];
        let [sum] = self.sums(a.len() / width, |row, [sum]| {
            let line = row * width..(row + 1) * width;
            for (a, b) in a[line.clone()].iter().zip(&b[line]) {
                *sum += a * b;
            }
        });
        sum
    }

    /// Counts of all ranks together.
    pub fn counts<const N: usize>(&self, own: [usize; N]) -> [usize; N] {
        let Some(all) = self.all(own.map(|count| count as f64)) else {
            return own;
        };
        let mut sums = [0; N];
        for counts in all.chunks_exact(N) {
            sums.iter_mut()
                .zip(counts)
                .for_each(|(sum, count)| *sum += *count as usize);
        }
        sums
    }

    /// Whether something holds on any rank.
    pub fn any(&self, own: bool) -> bool {
        self.counts([usize::from(own)]) != [0]
    }

    /// The least of one number a rank.
    pub fn least(&self, own: f64) -> f64 {
        let all = self.all([own]).unwrap_or_else(|| vec![own]);
        all.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The greatest.
    pub fn greatest(&self, own: f64) -> f64 {
        -self.least(-own)
    }

    /// The least value of a field.
    pub fn least_of(&self, own: &[f64]) -> f64 {
        self.least(folded(own, f64::INFINITY, f64::min))
    }

    /// The greatest value of a field.
    pub fn greatest_of(&self, own: &[f64]) -> f64 {
        self.greatest(folded(own, f64::NEG_INFINITY, f64::max))
    }

    /// The first value of a field.
    pub fn first_of(&self, own: &[f64]) -> f64 {
        let here = own.first().copied().unwrap_or(f64::NAN);
        let holder = (0..self.count()).position(|rank| !self.rows_of(rank).is_empty());
        match (self.all([here]), holder) {
            (Some(all), Some(rank)) => all[rank],
            _ => here,
        }
    }

    /// The numbers of all ranks; `None` where there is one, or where one has ended.
    pub fn all<const N: usize>(&self, own: [f64; N]) -> Option<Vec<f64>> {
        let slabs = self.slabs.as_ref()?;
        let lengths = (0..self.count()).map(|_| N);
        self.noted(slabs.gather_numbers(&own, lengths))
    }

    /// Numbers that the first rank knows, on all.
    pub fn told<const N: usize>(&self, own: Option<[f64; N]>) -> [f64; N] {
        let mut numbers = own.unwrap_or([f64::NAN; N]);
        match self.noted(self.told_by(FIRST, &mut numbers)) {
            Some(()) => numbers,
            None => [f64::NAN; N],
        }
    }
}

/// Values of a field that a thread folds before they come together, whatever the number of threads.
const FOLDED: usize = 1 << 14;

/// A fold of a field by the least or the greatest of two values.
fn folded(own: &[f64], none: f64, of: impl Fn(f64, f64) -> f64 + Sync) -> f64 {
    let parts: Vec<f64> = own
        .par_chunks(FOLDED)
        .map(|part| part.iter().copied().fold(none, &of))
        .collect();
    parts.into_iter().fold(none, &of)
}

/// What `add` adds for each of so many rows. It is called by its address: what the threads share their work with is much
/// code, and is compiled once.
fn of_each_row<const N: usize>(
    rows: usize,
    add: &(dyn Fn(usize, &mut [f64; N]) + Sync),
) -> Vec<[f64; N]> {
    let of_row = |row| {
        let mut sums = [0.0; N];
        add(row, &mut sums);
        sums
    };
    (0..rows).into_par_iter().map(of_row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::ranks::ThreadRanks;

    /// Sums, extremes, rows of others and what is handed to the first rank, as of one process.
    #[test]
    fn what_ranks_find_together_is_what_one_finds() {
        let shape = Shape {
            points: [6, 40],
            surface: [5, 21],
        };
        let value = |row: usize, x: usize| ((row * 31 + x * 7) as f64).sin();
        let field = |rows: Range<usize>, width: usize| -> Vec<f64> {
            rows.flat_map(|row| (0..width).map(move |x| value(row, x)))
                .collect()
        };
        let alone = Share::whole(shape);
        let (all, surface) = (field(0..40, 6), field(0..21, 5));
        for count in [1, 2, 3, 7] {
            std::thread::scope(|scope| {
                for rank in ThreadRanks::new(count) {
                    let (alone, all, surface) = (&alone, &all, &surface);
                    scope.spawn(move || {
                        let share = Share::on_ranks(shape, Some(Arc::new(rank)));
                        let own = field(share.rows(), 6);
                        let top = field(share.surface_rows(), 5);
                        assert_eq!([own.len(), top.len()], [share.len(), share.surface_len()]);
                        let bits = |sum: f64| sum.to_bits();
                        assert_eq!(bits(share.sum(&own)), bits(alone.sum(all)));
                        assert_eq!(
                            bits(share.product(&own, &own)),
                            bits(alone.product(all, all))
                        );
                        assert_eq!(share.least_of(&top), alone.least_of(surface));
                        assert_eq!(share.first_of(&own), all[0]);
                        assert_eq!(share.greatest_of(&own), alone.greatest_of(all));
                        assert_eq!(share.counts([top.len(), 1])[0], surface.len());
                        assert!(share.any(share.is_first()) && !share.any(false));
                        assert_eq!(share.told(share.is_first().then_some([4.0])), [4.0]);
                        let after = share
                            .surface_row_after(&top[..top.len().min(5)])
                            .expect("all ranks");
                        if !top.is_empty() {
                            let next = share.surface_rows().end % 21;
                            assert_eq!(after, field(next..next + 1, 5));
                        }
                        let twice =
                            |rank: usize| share.rows_of(rank).flat_map(|row| [row, 39 - row]);
                        let rows = share.fetch(
                            &own,
                            6,
                            |rank| share.rows_of(rank),
                            |rank| twice(rank).collect(),
                        );
                        let expected = twice(share.rank()).flat_map(|row| field(row..row + 1, 6));
                        assert!(rows.expect("all ranks").into_iter().eq(expected));
                        let mut given = 0;
                        let mut give = |rows: &mut [f64]| {
                            rows.copy_from_slice(&surface[given..given + rows.len()]);
                            given += rows.len();
                        };
                        let handed = share.from_first(true, &mut give).expect("all ranks");
                        assert_eq!(handed, top);
                        assert_eq!(given, usize::from(share.is_first()) * surface.len());
                        let mut taken = Vec::new();
                        let mut take = |rows: &[f64]| taken.extend_from_slice(rows);
                        share.to_first(&top, 5, &mut take).expect("all ranks");
                        assert!(!share.is_first() || taken == *surface);
                        assert!(share.is_first() || taken.is_empty());
                        share.failed().expect("all ranks");
                    });
                }
            });
        }
    }
}
