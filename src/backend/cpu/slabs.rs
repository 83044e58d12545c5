//! Slabs of a level's rows, one a rank.
//!
//! A slab of the first level ends on the border of a block, so that the blocks, and with them the order of all sums, are
//! those of one process. A coarser level has the rows that lie below: nothing is summed there.

use std::ops::Range;
use std::sync::Arc;

use super::CpuReal;
use super::blocks::{BLOCK, Held};
use crate::backend::ranks::{Parts, RankError, Ranks};
use crate::kernel::SUMS;

/// Rows of the largest slab of a level of so many rows.
pub fn largest_slab(rows: usize, ranks: usize) -> usize {
    (rows.div_ceil(BLOCK).div_ceil(ranks.max(1)) * BLOCK).min(rows)
}

/// Rows of a level by rank.
#[derive(Clone, Debug)]
pub(in crate::backend) struct Slabs {
    ranks: Arc<dyn Ranks>,
    /// The first row of each rank, and the number of rows.
    starts: Vec<usize>,
}

impl Slabs {
    /// Slabs of whole blocks, as equal as these allow; the last ranks of a small level hold none or fewer.
    pub fn of_blocks(ranks: Arc<dyn Ranks>, rows: usize) -> Slabs {
        let (blocks, count) = (rows.div_ceil(BLOCK), ranks.count());
        let start = |rank: usize| (blocks * rank / count * BLOCK).min(rows);
        Slabs {
            starts: (0..=count).map(start).collect(),
            ranks,
        }
    }

    /// Those of a level of so many rows that this one does not halve.
    pub fn of_level(&self, rows: usize) -> Slabs {
        Slabs::of_blocks(Arc::clone(&self.ranks), rows)
    }

    /// Those of a level of so many rows that this one halves: the rows below its slabs, where its slabs
    /// can be halved as often.
    pub fn halved(&self, rows: usize) -> Slabs {
        let all = self.starts.last().copied().unwrap_or(0);
        let ratio = all / rows.max(1);
        if ratio == 0 || !all.is_multiple_of(rows) || !BLOCK.is_multiple_of(ratio) {
            return self.of_level(rows);
        }
        Slabs {
            ranks: Arc::clone(&self.ranks),
            starts: self.starts.iter().map(|start| start / ratio).collect(),
        }
    }

    /// Who exchanges them.
    pub fn ranks(&self) -> &dyn Ranks {
        &*self.ranks
    }

    /// The rows of each rank.
    pub fn each(&self) -> impl ExactSizeIterator<Item = Range<usize>> + '_ {
        self.starts.windows(2).map(|ends| ends[0]..ends[1])
    }

    /// Those of a rank.
    pub fn rows_of(&self, rank: usize) -> Range<usize> {
        self.starts[rank]..self.starts[rank + 1]
    }

    /// Those of this process.
    pub fn own(&self) -> Range<usize> {
        self.rows_of(self.ranks.rank())
    }

    /// The same as blocks have it.
    pub(super) fn held(&self) -> Held {
        let own = self.own();
        Held {
            first: own.start,
            count: own.len(),
        }
    }

    /// The columns, in groups, that a rank transforms.
    pub fn groups_of(&self, rank: usize, groups: usize) -> Range<usize> {
        let count = self.ranks.count();
        groups * rank / count..groups * (rank + 1) / count
    }

    /// The same of so many columns, as columns.
    pub fn columns_of(&self, rank: usize, columns: usize) -> Range<usize> {
        let groups = self.groups_of(rank, columns.div_ceil(BLOCK));
        (groups.start * BLOCK).min(columns)..(groups.end * BLOCK).min(columns)
    }

    /// What each rank has so many of, one after another.
    pub fn gather_numbers(
        &self,
        own: &[f64],
        lengths: impl Iterator<Item = usize>,
    ) -> Result<Vec<f64>, RankError> {
        let lengths: Vec<usize> = lengths.map(|length| length * size_of::<f64>()).collect();
        let mut all = vec![0.0; lengths.iter().sum::<usize>() / size_of::<f64>()];
        let parts = Parts {
            bytes: bytemuck::cast_slice_mut(&mut all),
            lengths: &lengths,
        };
        self.ranks.gather(bytemuck::cast_slice(own), parts)?;
        Ok(all)
    }

    /// The first `sums` sums of all blocks, from those of the held ones.
    pub fn gather_sums(
        &self,
        own: &[[f64; SUMS]],
        sums: usize,
    ) -> Result<Vec<[f64; SUMS]>, RankError> {
        let own: Vec<f64> = own
            .iter()
            .flat_map(|block| &block[..sums])
            .copied()
            .collect();
        let blocks = self.each().map(|rows| rows.len().div_ceil(BLOCK));
        let all = self.gather_numbers(&own, blocks.map(|blocks| blocks * sums))?;
        let blocks = all.chunks_exact(sums).map(|block| {
            let mut padded = [0.0; SUMS];
            padded[..sums].copy_from_slice(block);
            padded
        });
        Ok(blocks.collect())
    }

    /// The rows before and after those of a rank, on the ring of all rows; none of an empty slab.
    fn edges_of(&self, rank: usize) -> Vec<usize> {
        let (own, all) = (self.rows_of(rank), self.starts[self.starts.len() - 1]);
        if own.is_empty() {
            Vec::new()
        } else {
            vec![(own.start + all - 1) % all, own.end % all]
        }
    }

    /// The row before the held ones and the one after, from the ranks that hold them; empty of an empty slab.
    pub fn edges<T: CpuReal>(&self, field: &[T], width: usize) -> Result<[Vec<T>; 2], RankError> {
        let bytes = width * size_of::<T>();
        let own = self.own();
        let mut send = Vec::new();
        let mut send_lengths = vec![0; self.ranks.count()];
        for (rank, length) in send_lengths.iter_mut().enumerate() {
            for row in self.edges_of(rank) {
                if own.contains(&row) {
                    let start = (row - own.start) * width;
                    send.extend_from_slice(&field[start..start + width]);
                    *length += bytes;
                }
            }
        }
        let wanted = self.edges_of(self.ranks.rank());
        let holder = |row: usize| self.each().position(|rows| rows.contains(&row));
        let holders: Vec<_> = wanted.iter().map(|&row| holder(row)).collect();
        let lengths: Vec<usize> = (0..self.ranks.count())
            .map(|rank| bytes * holders.iter().filter(|&&held| held == Some(rank)).count())
            .collect();
        let mut received = vec![T::zero(); wanted.len() * width];
        self.ranks.exchange(
            Parts {
                bytes: bytemuck::cast_slice(&send),
                lengths: &send_lengths,
            },
            Parts {
                bytes: bytemuck::cast_slice_mut(&mut received),
                lengths: &lengths,
            },
        )?;
        if wanted.is_empty() {
            return Ok([Vec::new(), Vec::new()]);
        }
        // They come in the order of their holders.
        let after = received.split_off(width);
        if holders[0] <= holders[1] {
            Ok([received, after])
        } else {
            Ok([after, received])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::ranks::ThreadRanks;

    fn slabs(ranks: usize, rows: usize) -> Vec<Slabs> {
        let ranks = ThreadRanks::new(ranks).into_iter();
        ranks
            .map(|rank| Slabs::of_blocks(Arc::new(rank), rows))
            .collect()
    }

    /// Every row once, in whole blocks; coarser levels have the rows below.
    #[test]
    fn rows_of_ranks() {
        for (ranks, rows) in [(1, 64), (3, 64), (4, 127), (5, 30), (9, 64)] {
            let all = slabs(ranks, rows);
            let each: Vec<_> = all[0].each().collect();
            assert_eq!(each.len(), ranks);
            assert_eq!(each[0].start, 0);
            assert_eq!(each[ranks - 1].end, rows);
            for pair in each.windows(2) {
                assert_eq!(pair[0].end, pair[1].start);
                assert!(pair[0].end.is_multiple_of(BLOCK) || pair[0].end == rows);
            }
            if rows.is_multiple_of(BLOCK) {
                let most = each.iter().map(ExactSizeIterator::len).max();
                assert_eq!(most, Some(largest_slab(rows, ranks)));
                let below = all[0].halved(rows / BLOCK);
                for (fine, coarse) in each.iter().zip(below.each()) {
                    assert_eq!(fine.len(), coarse.len() * BLOCK);
                }
            }
        }
    }

    /// The row before and the one after are those of the ring, from whichever rank has them.
    #[test]
    fn edges_are_the_neighbours_of_the_ring() {
        let width = 3;
        for (ranks, rows) in [(2, 16), (3, 64), (4, 30), (5, 8), (2, 2), (6, 24)] {
            std::thread::scope(|scope| {
                for slabs in slabs(ranks, rows) {
                    scope.spawn(move || {
                        let own = slabs.own();
                        let value = |row: usize, x: usize| (row * width + x) as f64;
                        let line = |row: usize| (0..width).map(move |x| value(row, x));
                        let field: Vec<f64> = own.clone().flat_map(line).collect();
                        let [before, after] =
                            slabs.edges(&field, width).expect("all ranks are here");
                        if own.is_empty() {
                            assert!(before.is_empty() && after.is_empty());
                        } else {
                            assert!(before.into_iter().eq(line((own.start + rows - 1) % rows)));
                            assert!(after.into_iter().eq(line(own.end % rows)));
                        }
                    });
                }
            });
        }
    }
}
