//! Columns of a table over wavevectors, of which each rank holds those that it transforms.

use std::ops::Range;

use super::Share;
use crate::backend::BackendError;

/// Bytes of the columns that a rank takes at once from the rows of all, at least and at most.
const LEAST_ROUND: usize = 4 << 20;
const MOST_ROUND: usize = 64 << 20;
/// Rounds in which the columns of a table between these go.
const ROUNDS: usize = 4;

/// A part of so many, as equal as those of other ranks allow.
fn part(all: usize, rank: usize, count: usize) -> Range<usize> {
    all * rank / count..all * (rank + 1) / count
}

impl Share {
    /// The columns of the half spectrum that a rank transforms; all where it is alone.
    pub fn columns_of(&self, rank: usize) -> Range<usize> {
        let all = self.shape.points[0] / 2 + 1;
        match &self.slabs {
            None => 0..all,
            Some(slabs) => slabs.columns_of(rank, all),
        }
    }

    /// Those of this process.
    pub fn columns(&self) -> Range<usize> {
        self.columns_of(self.rank())
    }

    /// The columns that this process holds of a table of so many rows, one after another. `make` makes some rows, one after another,
    /// each of a value for each column of the half spectrum: each rank makes a part of them, and sends the others
    /// their columns, some at a time.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn columns_of_rows(
        &self,
        rows: usize,
        make: impl Fn(Range<usize>) -> Vec<f64>,
    ) -> Result<Vec<f64>, BackendError> {
        let own = self.columns().len() * rows * size_of::<f64>();
        let most = (0..self.count()).map(|rank| self.columns_of(rank).len());
        let most = most.max().unwrap_or(0);
        let round = (own / ROUNDS).clamp(LEAST_ROUND, MOST_ROUND);
        // The same on every rank, whatever it holds itself.
        let [round] = self.told(Some([round as f64]));
        let at_once = (round as usize / (rows * size_of::<f64>())).max(1);
        self.in_rounds(rows, at_once, most, make)
    }

    /// The same in rounds of so many columns a rank, of which one has `most`.
    fn in_rounds(
        &self,
        rows: usize,
        at_once: usize,
        most: usize,
        make: impl Fn(Range<usize>) -> Vec<f64>,
    ) -> Result<Vec<f64>, BackendError> {
        let width = self.shape.points[0] / 2 + 1;
        let here = part(rows, self.rank(), self.count());
        let made = make(here.clone());
        // A column of the rows that this rank makes.
        let column_of = |column: usize| made.iter().skip(column).step_by(width);
        let own = self.columns();
        let mut columns = Vec::with_capacity(own.len() * rows);
        if self.is_whole() {
            own.for_each(|column| columns.extend(column_of(column)));
            return Ok(columns);
        }
        for first in (0..most).step_by(at_once) {
            let taken = |rank: usize| {
                let all = self.columns_of(rank);
                (all.start + first).min(all.end)..(all.start + first + at_once).min(all.end)
            };
            let ranks = 0..self.count();
            let lengths: Vec<usize> = ranks.clone().map(|r| taken(r).len() * here.len()).collect();
            let mut sent = Vec::with_capacity(lengths.iter().sum());
            ranks.clone().flat_map(taken).for_each(|column| {
                sent.extend(column_of(column));
            });
            let count = taken(self.rank()).len();
            let parts: Vec<Range<usize>> =
                ranks.map(|rank| part(rows, rank, self.count())).collect();
            let expected: Vec<usize> = parts.iter().map(|rows| rows.len() * count).collect();
            let received = self.exchange(&sent, &lengths, &expected)?;
            drop(sent);
            let start = columns.len();
            columns.resize(start + count * rows, 0.0);
            let mut left = &received[..];
            for rows_there in parts.iter().filter(|rows| !rows.is_empty()) {
                let (there, rest) = left.split_at(rows_there.len() * count);
                let to = columns[start..].chunks_exact_mut(rows);
                for (column, values) in to.zip(there.chunks_exact(rows_there.len())) {
                    column[rows_there.clone()].copy_from_slice(values);
                }
                left = rest;
            }
        }
        Ok(columns)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::thread;

    use super::*;
    use crate::backend::Shape;
    use crate::backend::ranks::ThreadRanks;

    /// Every rank has its columns of all rows, whatever the rounds; ranks that transform none, too.
    #[test]
    fn columns_of_the_rows_of_all() {
        let rows = 13;
        for (points, counts) in [([46, 24], [2, 3, 5]), ([9, 8], [1, 2, 4])] {
            let width = points[0] / 2 + 1;
            let value = |row: usize, column: usize| (100 * row + column) as f64;
            let make = |rows: Range<usize>| -> Vec<f64> {
                let line = |row| (0..width).map(move |column| value(row, column));
                rows.flat_map(line).collect()
            };
            for (count, at_once) in counts.into_iter().flat_map(|n| [1, 3, 100].map(|w| (n, w))) {
                thread::scope(|scope| {
                    for rank in ThreadRanks::new(count) {
                        scope.spawn(move || {
                            let shape = Shape::whole(points[0], points[1]);
                            let share = Share::on_ranks(shape, Some(Arc::new(rank)));
                            let own = share.columns();
                            let most = (0..count).map(|rank| share.columns_of(rank).len());
                            let most = most.max().unwrap_or(0);
                            let expected: Vec<f64> = own
                                .flat_map(|column| (0..rows).map(move |row| value(row, column)))
                                .collect();
                            let found = share.in_rounds(rows, at_once, most, make);
                            assert_eq!(found.expect("all ranks"), expected);
                            let found = share.columns_of_rows(rows, make);
                            assert_eq!(found.expect("all ranks"), expected);
                        });
                    }
                });
            }
        }
    }
}
