//! Rows of fields on their way from rank to rank.

use std::ops::Range;

use bytemuck::Pod;

use super::{FIRST, Share};
use crate::backend::BackendError;
use crate::backend::ranks::Parts;

/// Bytes of the rows that a rank sends at once.
const ROUND: usize = 16 << 20;

/// Rows on their way from rank to rank in rounds, in which no rank sends or takes more than so many. Every rank finds the same.
struct Rounds {
    /// Each rank's rows that are still to come and the ranks that hold them, the next one last.
    left: Vec<Vec<(usize, usize)>>,
    at_once: usize,
}

impl Rounds {
    fn new(
        count: usize,
        at_once: usize,
        held: &dyn Fn(usize) -> Range<usize>,
        wanted: &dyn Fn(usize) -> Vec<usize>,
    ) -> Rounds {
        let mut holders: Vec<(Range<usize>, usize)> =
            (0..count).map(|rank| (held(rank), rank)).collect();
        holders.retain(|(rows, _)| !rows.is_empty());
        holders.sort_by_key(|(rows, _)| rows.start);
        let with_holder = |row: usize| {
            let after = holders.partition_point(|(rows, _)| rows.start <= row);
            let (rows, rank) = &holders[after.checked_sub(1)?];
            rows.contains(&row).then_some((row, *rank))
        };
        let of_rank = |rank| -> Vec<(usize, usize)> {
            let asked = wanted(rank).into_iter().rev();
            asked.filter_map(with_holder).collect()
        };
        Rounds {
            left: (0..count).map(of_rank).collect(),
            at_once,
        }
    }
}

impl Iterator for Rounds {
    /// The rows that each rank takes in a round, and the ranks that hold them.
    type Item = Vec<Vec<(usize, usize)>>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut sent = vec![0; self.left.len()];
        let round: Vec<Vec<_>> = self
            .left
            .iter_mut()
            .map(|left| {
                let mut taken = Vec::new();
                while let Some(&(row, holder)) = left.last()
                    && taken.len() < self.at_once
                    && sent[holder] < self.at_once
                {
                    left.pop();
                    sent[holder] += 1;
                    taken.push((row, holder));
                }
                taken
            })
            .collect();
        round.iter().any(|taken| !taken.is_empty()).then_some(round)
    }
}

impl Share {
    /// Sends each rank its numbers, one rank after another, of as many as the lengths say, and returns those that come
    /// from each.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn exchange(
        &self,
        send: &[f64],
        lengths: &[usize],
        expected: &[usize],
    ) -> Result<Vec<f64>, BackendError> {
        let Some(ranks) = self.ranks() else {
            return Ok(send.to_vec());
        };
        let bytes = |lengths: &[usize]| -> Vec<usize> {
            let lengths = lengths.iter();
            lengths.map(|length| length * size_of::<f64>()).collect()
        };
        let mut received = vec![0.0; expected.iter().sum()];
        let exchanged = ranks.exchange(
            Parts {
                bytes: bytemuck::cast_slice(send),
                lengths: &bytes(lengths),
            },
            Parts {
                bytes: bytemuck::cast_slice_mut(&mut received),
                lengths: &bytes(expected),
            },
        );
        self.noted(exchanged);
        self.failed()?;
        Ok(received)
    }

    /// Rows of a field that lie on other ranks: `held` and `wanted` say what each rank has and asks for, by the
    /// numbers of the rows. Every row asked for lies on a rank.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn fetch<T: Pod>(
        &self,
        own: &[T],
        width: usize,
        held: impl Fn(usize) -> Range<usize>,
        wanted: impl Fn(usize) -> Vec<usize>,
    ) -> Result<Vec<T>, BackendError> {
        let mut found = Vec::with_capacity(wanted(self.rank()).len() * width);
        let take = |_, row: &[T]| found.extend_from_slice(row);
        self.fetch_each(own, width, held, wanted, take)?;
        Ok(found)
    }

    /// The same some rows at a time, of which no rank sends or receives more than a round holds, or one: `take` has the number
    /// and the values of each row, in the order in which this rank asks for them.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn fetch_each<T: Pod>(
        &self,
        own: &[T],
        width: usize,
        held: impl Fn(usize) -> Range<usize>,
        wanted: impl Fn(usize) -> Vec<usize>,
        mut take: impl FnMut(usize, &[T]),
    ) -> Result<(), BackendError> {
        let at_once = (ROUND / (width * size_of::<T>()).max(1)).max(1);
        self.fetch_at_most(at_once, own, width, &held, &wanted, &mut take)
    }

    /// The same in rounds of so many rows, compiled once for a type.
    pub(super) fn fetch_at_most<T: Pod>(
        &self,
        at_once: usize,
        own: &[T],
        width: usize,
        held: &dyn Fn(usize) -> Range<usize>,
        wanted: &dyn Fn(usize) -> Vec<usize>,
        take: &mut dyn FnMut(usize, &[T]),
    ) -> Result<(), BackendError> {
        let here = self.rank();
        let first = held(here).start;
        let line = |row: usize| &own[(row - first) * width..(row + 1 - first) * width];
        let Some(ranks) = self.ranks() else {
            wanted(here)
                .into_iter()
                .for_each(|row| take(row, line(row)));
            return Ok(());
        };
        let bytes = width * size_of::<T>();
        for round in Rounds::new(ranks.count(), at_once, held, wanted) {
            let mut sent = Vec::new();
            let mut send_lengths = vec![0; ranks.count()];
            for (length, rows) in send_lengths.iter_mut().zip(&round) {
                for (row, _) in rows.iter().filter(|(_, holder)| *holder == here) {
                    sent.extend_from_slice(line(*row));
                    *length += bytes;
                }
            }
            let mut lengths = vec![0; ranks.count()];
            for (_, holder) in &round[here] {
                lengths[*holder] += bytes;
            }
            let mut received = vec![T::zeroed(); round[here].len() * width];
            let exchanged = ranks.exchange(
                Parts {
                    bytes: bytemuck::cast_slice(&sent),
                    lengths: &send_lengths,
                },
                Parts {
                    bytes: bytemuck::cast_slice_mut(&mut received),
                    lengths: &lengths,
                },
            );
            self.noted(exchanged);
            self.failed()?;
            // They come by the ranks that hold them, of each in the order asked for.
            let mut next = 0;
            let mut places = lengths;
            for place in &mut places {
                next += std::mem::replace(place, next / bytes.max(1));
            }
            for (row, holder) in &round[here] {
                let start = places[*holder] * width;
                places[*holder] += 1;
                take(*row, &received[start..start + width]);
            }
        }
        Ok(())
    }

    /// The surface row before those of this rank and the one after them. A row is empty where the surface ends, and both are
    /// where this rank holds no rows.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn surface_rows_beside<T: Pod>(&self, own: &[T]) -> Result<[Vec<T>; 2], BackendError> {
        let (width, last) = (self.shape.surface[0], self.shape.surface[1]);
        let beside = |rank: usize| {
            let rows = self.surface_rows_of(rank);
            let before = rows.start.checked_sub(1).filter(|_| !rows.is_empty());
            let after = Some(rows.end).filter(|row| *row < last && !rows.is_empty());
            [before, after]
        };
        let wanted = |rank: usize| beside(rank).into_iter().flatten().collect();
        let held = |rank: usize| self.surface_rows_of(rank);
        let mut found = self.fetch(own, width, held, wanted)?;
        let after = match beside(self.rank()) {
            [None, _] => std::mem::take(&mut found),
            [Some(_), _] => found.split_off(width),
        };
        Ok([found, after])
    }

    /// The rows of the surface before and after those of this rank, on the ring of all rows, from the first and the last row of each
    /// rank; both are empty of a rank without any.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn surface_rows_around<T: Pod>(
        &self,
        first: &[T],
        last: &[T],
    ) -> Result<[Vec<T>; 2], BackendError> {
        let all = self.shape.surface[1];
        let before = |rank: usize| {
            let rows = self.surface_rows_of(rank);
            let earlier = (!rows.is_empty()).then(|| (rows.start + all - 1) % all);
            earlier.into_iter().collect()
        };
        let lasts = |rank: usize| {
            let rows = self.surface_rows_of(rank);
            rows.start.max(rows.end.saturating_sub(1))..rows.end
        };
        let before = self.fetch(last, self.shape.surface[0], lasts, before)?;
        Ok([before, self.surface_row_after(first)?])
    }

    /// The row of the surface after those of this rank, on the ring of all rows, from the first row of each rank; none
    /// of a rank without any.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn surface_row_after<T: Pod>(&self, first: &[T]) -> Result<Vec<T>, BackendError> {
        let all = self.shape.surface[1];
        let after = |rank: usize| {
            let rows = self.surface_rows_of(rank);
            let next = (!rows.is_empty()).then(|| rows.end % all);
            next.into_iter().collect()
        };
        let firsts = |rank: usize| {
            let rows = self.surface_rows_of(rank);
            rows.start..rows.end.min(rows.start + 1)
        };
        self.fetch(first, self.shape.surface[0], firsts, after)
    }

    /// Hands a field to the first rank, which takes it row after row, some rows at once; its values a row are `width`.
    /// The others take nothing.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn to_first<T: Pod>(
        &self,
        own: &[T],
        width: usize,
        take: &mut dyn FnMut(&[T]),
    ) -> Result<(), BackendError> {
        let Some(ranks) = self.ranks() else {
            take(own);
            return Ok(());
        };
        let lengths = match self.all([own.len() as f64]) {
            Some(lengths) => lengths,
            None => return self.failed(),
        };
        let leads = self.is_first();
        let at_once = (ROUND / (width * size_of::<T>()).max(1)).max(1) * width;
        if leads {
            take(own);
        }
        for (rank, &length) in lengths.iter().enumerate().skip(1) {
            let length = length as usize;
            for start in (0..length).step_by(at_once.max(1)) {
                let count = at_once.min(length - start);
                let bytes = count * size_of::<T>();
                let mut lengths = vec![0; ranks.count()];
                let (sent, mut received) = if leads {
                    lengths[rank] = bytes;
                    (&own[..0], vec![T::zeroed(); count])
                } else if rank == ranks.rank() {
                    (&own[start..start + count], Vec::new())
                } else {
                    (&own[..0], Vec::new())
                };
                let mut send_lengths = vec![0; ranks.count()];
                send_lengths[FIRST] = size_of_val(sent);
                let exchanged = ranks.exchange(
                    Parts {
                        bytes: bytemuck::cast_slice(sent),
                        lengths: &send_lengths,
                    },
                    Parts {
                        bytes: bytemuck::cast_slice_mut(&mut received),
                        lengths: &lengths,
                    },
                );
                if self.noted(exchanged).is_none() {
                    return self.failed();
                }
                if leads {
                    take(&received);
                }
            }
        }
        Ok(())
    }

    /// This process's rows of a field, or of a surface field. The first rank alone has the values: `give` fills some
    /// rows at once there, in the order of all rows, and is called nowhere else.
    ///
    /// # Errors
    /// A rank has ended.
    pub fn from_first<T: Pod>(
        &self,
        is_surface: bool,
        give: &mut dyn FnMut(&mut [T]),
    ) -> Result<Vec<T>, BackendError> {
        let [width, _] = match is_surface {
            true => self.shape.surface,
            false => self.shape.points,
        };
        let length_of = |rank| match is_surface {
            true => self.surface_rows_of(rank).len() * width,
            false => self.rows_of(rank).len() * width,
        };
        let mut own = vec![T::zeroed(); length_of(self.rank())];
        let at_once = (ROUND / (width * size_of::<T>()).max(1)).max(1) * width;
        if self.is_first() {
            own.chunks_mut(at_once).for_each(&mut *give);
        }
        let Some(ranks) = self.ranks() else {
            return Ok(own);
        };
        for rank in 1..ranks.count() {
            let length = length_of(rank);
            for start in (0..length).step_by(at_once) {
                let count = at_once.min(length - start);
                let [mut send_lengths, mut lengths] = [(); 2].map(|()| vec![0; ranks.count()]);
                let mut sent = Vec::new();
                let mut received = &mut own[..0];
                if self.is_first() {
                    sent.resize(count, T::zeroed());
                    give(&mut sent);
                    send_lengths[rank] = count * size_of::<T>();
                } else if rank == ranks.rank() {
                    received = &mut own[start..start + count];
                    lengths[FIRST] = count * size_of::<T>();
                }
                let exchanged = ranks.exchange(
                    Parts {
                        bytes: bytemuck::cast_slice(&sent),
                        lengths: &send_lengths,
                    },
                    Parts {
                        bytes: bytemuck::cast_slice_mut(received),
                        lengths: &lengths,
                    },
                );
                self.noted(exchanged);
                self.failed()?;
            }
        }
        Ok(own)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::thread;

    use super::*;
    use crate::backend::Shape;
    use crate::backend::ranks::ThreadRanks;

    /// Rows of one share's map come in the order in which a rank of another asks for them, in rounds of any size, from ranks that hold
    /// none or all, and to ranks that ask for none or all.
    #[test]
    fn rows_come_in_the_order_asked_for() {
        let width = 3;
        let line = |row: usize| (0..width).map(move |x| (10 * row + x) as f64);
        for (count, at_once) in [1, 2, 3, 7]
            .into_iter()
            .flat_map(|n| [1, 2, 100].map(|w| (n, w)))
        {
            thread::scope(|scope| {
                for rank in ThreadRanks::new(count) {
                    scope.spawn(move || {
                        let share = Share::on_ranks(Shape::whole(3, 37), Some(Arc::new(rank)));
                        let more = share.of(Shape::whole(3, 74));
                        let held = |rank: usize| share.rows_of(rank);
                        let own: Vec<f64> = held(share.rank()).flat_map(line).collect();
                        let mirrored = |rank: usize| -> Vec<usize> {
                            let rows = more.rows_of(rank);
                            rows.map(|row| row.min(73 - row)).collect()
                        };
                        let all_of_first = |rank: usize| match rank {
                            0 => vec![36, 0, 36],
                            _ => held(0).rev().collect(),
                        };
                        for wanted in [&mirrored as &dyn Fn(usize) -> Vec<usize>, &all_of_first] {
                            let mut found = Vec::new();
                            let mut take = |row: usize, values: &[f64]| {
                                assert!(line(row).eq(values.iter().copied()));
                                found.push(row);
                            };
                            let fetched = share
                                .fetch_at_most(at_once, &own, width, &held, &wanted, &mut take);
                            fetched.expect("all ranks");
                            assert_eq!(found, wanted(share.rank()));
                        }
                    });
                }
            });
        }
    }

    /// No rank sends or takes more rows in a round than it may, whoever asks; where nobody waits for another, the rounds are as few
    /// as these allow.
    #[test]
    fn rounds_are_bounded() {
        let held = |rank: usize| 8 * rank..8 * rank + 8;
        let all = |_: usize| (0..32_usize).collect();
        let reversed = |rank: usize| held(3 - rank).collect();
        for at_once in [1, 3, 8] {
            for (wanted, most) in [
                (&all as &dyn Fn(usize) -> Vec<usize>, 128),
                (&reversed, 8_usize.div_ceil(at_once)),
            ] {
                let mut found = vec![Vec::new(); 4];
                let mut count = 0;
                for round in Rounds::new(4, at_once, &held, &wanted) {
                    let mut sent = [0; 4];
                    for (found, rows) in found.iter_mut().zip(round) {
                        assert!(rows.len() <= at_once);
                        rows.iter().for_each(|(_, holder)| sent[*holder] += 1);
                        found.extend(rows.into_iter().map(|(row, _)| row));
                    }
                    assert!(sent.iter().all(|sent| *sent <= at_once));
                    count += 1;
                }
                assert!(count <= most);
                for (rank, found) in found.into_iter().enumerate() {
                    assert_eq!(found, wanted(rank));
                }
            }
        }
    }
}
