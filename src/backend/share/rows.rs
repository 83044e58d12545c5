//! Rows of fields on their way from rank to rank.

use std::ops::Range;

use bytemuck::Pod;

use super::{FIRST, Share};
use crate::backend::BackendError;
use crate::backend::ranks::Parts;

/// Bytes of the rows that a rank sends at once.
const ROUND: usize = 16 << 20;

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
    /// numbers of the rows.
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
        let bytes = width * size_of::<T>();
        let at_once = (ROUND / bytes.max(1)).max(1);
        let here = self.rank();
        let line = |row: usize| {
            let start = (row - held(here).start) * width;
            start..start + width
        };
        let asked = wanted(here);
        let mut found = vec![T::zeroed(); asked.len() * width];
        let Some(ranks) = self.ranks() else {
            for (place, row) in found.chunks_exact_mut(width).zip(asked) {
                place.copy_from_slice(&own[line(row)]);
            }
            return Ok(found);
        };
        let others: Vec<Vec<usize>> = (0..ranks.count()).map(&wanted).collect();
        let most = (0..ranks.count()).map(|rank| held(rank).len()).max();
        for first in (0..most.unwrap_or(0)).step_by(at_once) {
            let offered = |rank: usize| {
                let rows = held(rank);
                (rows.start + first).min(rows.end)..(rows.start + first + at_once).min(rows.end)
            };
            let mine = offered(here);
            let mut sent = Vec::new();
            let mut send_lengths = vec![0; ranks.count()];
            for (length, rows) in send_lengths.iter_mut().zip(&others) {
                for &row in rows.iter().filter(|row| mine.contains(row)) {
                    sent.extend_from_slice(&own[line(row)]);
                    *length += bytes;
                }
            }
            // Places of the rows in the order in which they come.
            let places: Vec<Vec<usize>> = (0..ranks.count())
                .map(|rank| {
                    let rows = offered(rank);
                    let of_rank = asked.iter().enumerate();
                    let of_rank = of_rank.filter(|(_, row)| rows.contains(row));
                    of_rank.map(|(place, _)| place).collect()
                })
                .collect();
            let lengths: Vec<usize> = places.iter().map(|places| places.len() * bytes).collect();
            let mut received = vec![T::zeroed(); lengths.iter().sum::<usize>() / size_of::<T>()];
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
            if self.noted(exchanged).is_none() {
                break;
            }
            let lines = received.chunks_exact(width);
            for (line, &place) in lines.zip(places.iter().flatten()) {
                found[place * width..(place + 1) * width].copy_from_slice(line);
            }
        }
        self.failed()?;
        Ok(found)
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
