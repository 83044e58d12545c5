//! The columns of a transform whose rows lie on several ranks: each rank takes some groups of columns from all, transforms
//! them, and sends them back to the places from which they came.

use std::ops::Range;

use rayon::prelude::*;
use rustfft::num_complex::Complex;

use super::CpuReal;
use super::blocks::BLOCK;
use super::slabs::Slabs;
use super::transform::Transform;
use crate::backend::ranks::{Parts, RankError};

/// Bytes of the columns that a rank takes at once, at least and at most: the exchange goes in rounds, so that its buffers
/// stay small beside the fields of a large grid, and below the 2^31 bytes of one message.
const LEAST_ROUND: usize = 1 << 20;
const MOST_ROUND: usize = 64 << 20;
/// Rounds in which the columns of a grid between these go.
const ROUNDS: usize = 8;

/// Numbers of a complex one.
pub(super) const PAIR: usize = 2;

/// Groups of columns of so many rows, of numbers of so many bytes, that a rank takes in a round; the same on every
/// rank.
fn groups_in_round(round: usize, number: usize, rows: usize) -> usize {
    (round / (PAIR * number * BLOCK * rows)).max(1)
}

/// Bytes of a round of a level's columns, of numbers of so many bytes.
pub(super) fn round_bytes([nx, ny]: [usize; 2], number: usize, ranks: usize) -> usize {
    let own = PAIR * number * (nx / 2 + 1) * ny / ranks.max(1);
    (own / ROUNDS).clamp(LEAST_ROUND, MOST_ROUND)
}

/// Bytes of the buffers in which a rank exchanges the columns of a level, of numbers of so many bytes: its own rows
/// of the columns of all, and all rows of its own columns.
pub fn exchange_bytes([nx, ny]: [usize; 2], number: usize, ranks: usize) -> usize {
    if ranks < 2 {
        return 0;
    }
    let group = PAIR * number * BLOCK * ny;
    let share = (nx / 2 + 1).div_ceil(BLOCK).div_ceil(ranks);
    let round = round_bytes([nx, ny], number, ranks);
    2 * group * share.min(groups_in_round(round, number, ny))
}

/// Lays complex numbers down as pairs.
pub(super) fn lay<T: Copy>(values: &[Complex<T>], pairs: &mut [T]) {
    let (pairs, _) = pairs.as_chunks_mut::<PAIR>();
    for (pair, value) in pairs.iter_mut().zip(values) {
        *pair = [value.re, value.im];
    }
}

/// Takes them up again.
pub(super) fn take_up<T: Copy>(pairs: &[T], values: &mut [Complex<T>]) {
    let (pairs, _) = pairs.as_chunks::<PAIR>();
    for (value, &[re, im]) in values.iter_mut().zip(pairs) {
        *value = Complex::new(re, im);
    }
}

/// The rows of a group's columns from each slab, column by column.
pub(super) type Pieces<'a, T> = Vec<(Range<usize>, &'a mut [T])>;

/// Bytes of so many numbers for each rank.
fn bytes<T>(numbers: impl Iterator<Item = usize>) -> Vec<usize> {
    numbers.map(|count| count * size_of::<T>()).collect()
}

impl<T: CpuReal> Transform<T> {
    /// As [`multiply`](Transform::multiply), by the factors of the columns that this rank transforms, in rounds of so
    /// many bytes.
    pub fn multiply_across(
        &mut self,
        factors: &[T],
        energy: bool,
        slabs: &Slabs,
        round: usize,
    ) -> Result<f64, RankError> {
        self.take();
        let ranks = slabs.ranks();
        let rows = self.shape.points[1];
        let shares: Vec<Range<usize>> = (0..ranks.count())
            .map(|rank| slabs.groups_of(rank, self.groups))
            .collect();
        let own = shares[ranks.rank()].clone();
        let mut energies = vec![0.0; own.len()];
        let at_once = groups_in_round(round, size_of::<T>(), rows);
        let most = shares.iter().map(ExactSizeIterator::len).max().unwrap_or(0);
        let mut exchanged = std::mem::take(&mut self.exchanged);
        for first in (0..most).step_by(at_once) {
            let cut = |share: &Range<usize>| {
                let start = (share.start + first).min(share.end);
                start..(start + at_once).min(share.end)
            };
            let parts: Vec<Range<usize>> = shares.iter().map(cut).collect();
            let done = first.min(energies.len())..(first + at_once).min(energies.len());
            let here = parts[ranks.rank()].clone();
            self.round(
                factors,
                own.start,
                energy,
                slabs,
                &parts,
                here,
                &mut energies[done],
                &mut exchanged,
            )?;
        }
        self.exchanged = exchanged;
        if !energy {
            return Ok(0.0);
        }
        let lengths = shares.iter().map(ExactSizeIterator::len);
        let energies = slabs.gather_numbers(&energies, lengths)?;
        Ok(energies.iter().sum())
    }

    /// One round: `parts` are the groups that each rank takes, `here` those of this one.
    #[allow(clippy::too_many_arguments)]
    fn round(
        &mut self,
        factors: &[T],
        first_group: usize,
        energy: bool,
        slabs: &Slabs,
        parts: &[Range<usize>],
        here: Range<usize>,
        energies: &mut [f64],
        [own_rows, all_rows]: &mut [Vec<T>; 2],
    ) -> Result<(), RankError> {
        let (ranks, rows) = (slabs.ranks(), self.shape.points[1]);
        let (held, count) = (slabs.own().len(), here.len());
        let per_group = PAIR * BLOCK * held;
        let per_part = bytes::<T>(parts.iter().map(|part| part.len() * per_group));
        let per_slab = bytes::<T>(slabs.each().map(|rows| PAIR * BLOCK * rows.len() * count));

        // This rank's rows of the columns of every rank: group, column, row.
        let groups: Vec<usize> = parts.iter().flat_map(Clone::clone).collect();
        own_rows.resize(groups.len() * per_group, T::zero());
        if held > 0 {
            let pieces = own_rows.par_chunks_exact_mut(per_group).zip(&groups);
            pieces.for_each(|(piece, &group)| self.lay_rows(group, held, piece));
        }
        all_rows.resize(PAIR * BLOCK * rows * count, T::zero());
        ranks.exchange(
            Parts {
                bytes: bytemuck::cast_slice(own_rows),
                lengths: &per_part,
            },
            Parts {
                bytes: bytemuck::cast_slice_mut(all_rows),
                lengths: &per_slab,
            },
        )?;

        // What came from each rank, group by group.
        let mut pieces: Vec<Pieces<T>> = (0..count).map(|_| Vec::new()).collect();
        let mut left = &mut all_rows[..];
        for slab in slabs.each().filter(|slab| !slab.is_empty()) {
            for pieces in &mut pieces {
                let piece = left.split_off_mut(..PAIR * BLOCK * slab.len());
                pieces.extend(piece.map(|piece| (slab.clone(), piece)));
            }
        }
        let context = self.columns(factors, first_group * BLOCK, energy);
        let lines = pieces.par_iter_mut().zip(energies).enumerate();
        lines.for_each(|(group, (pieces, energy))| {
            *energy = context.pieces(here.start + group, pieces);
        });
        drop(pieces);
        ranks.exchange(
            Parts {
                bytes: bytemuck::cast_slice(all_rows),
                lengths: &per_slab,
            },
            Parts {
                bytes: bytemuck::cast_slice_mut(own_rows),
                lengths: &per_part,
            },
        )?;
        if held > 0 {
            let pieces: Vec<(usize, &[T])> = groups
                .into_iter()
                .zip(own_rows.chunks_exact(per_group))
                .collect();
            self.take_rows(held, &pieces);
        }
        Ok(())
    }

    /// Lays down the held rows of a group's columns, column by column.
    fn lay_rows(&self, group: usize, held: usize, piece: &mut [T]) {
        let tiles = self.tiles()[group..].iter().step_by(self.groups);
        for (block, tile) in tiles.enumerate() {
            let rows = block * BLOCK..held.min((block + 1) * BLOCK);
            let columns = piece.chunks_exact_mut(PAIR * held);
            for (line, column) in tile.chunks_exact(BLOCK).zip(columns) {
                lay(
                    &line[..rows.len()],
                    &mut column[PAIR * rows.start..PAIR * rows.end],
                );
            }
        }
    }

    /// Puts those of some groups back.
    fn take_rows(&mut self, held: usize, pieces: &[(usize, &[T])]) {
        let groups = self.groups;
        let blocks = self.tiles_mut().par_chunks_exact_mut(groups);
        blocks.enumerate().for_each(|(block, tiles)| {
            let rows = block * BLOCK..held.min((block + 1) * BLOCK);
            for &(group, piece) in pieces {
                let columns = piece.chunks_exact(PAIR * held);
                for (line, column) in tiles[group].chunks_exact_mut(BLOCK).zip(columns) {
                    take_up(&column[PAIR * rows.start..PAIR * rows.end], line);
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::thread;

    use super::*;
    use crate::backend::Shape;
    use crate::backend::cpu::blocks::Tile;
    use crate::backend::ranks::{Ranks, ThreadRanks};

    /// Spectra of some rows of a shape, each number told by its row and column.
    fn fill(tiles: &mut [Tile<f64>], groups: usize, rows: Range<usize>) {
        for (place, tile) in tiles.iter_mut().enumerate() {
            for (at, value) in tile.iter_mut().enumerate() {
                let row = rows.start + place / groups * BLOCK + at % BLOCK;
                let column = place % groups * BLOCK + at / BLOCK;
                let number = (row * 31 + column * 7) as f64;
                *value = Complex::new(number.sin(), (number * 0.3).cos());
            }
        }
    }

    /// The held rows of all columns, bit by bit.
    fn taken(tiles: &[Tile<f64>], groups: usize, held: usize, columns: usize) -> Vec<Vec<u64>> {
        let at = |row: usize, column: usize| {
            let tile = &tiles[row / BLOCK * groups + column / BLOCK];
            tile[column % BLOCK * BLOCK + row % BLOCK]
        };
        let line = |row: usize| (0..columns).map(move |column| at(row, column));
        let bits = |value: Complex<f64>| [value.re.to_bits(), value.im.to_bits()];
        (0..held)
            .map(|row| line(row).flat_map(bits).collect())
            .collect()
    }

    /// One group of columns in a round, several, or all: each rank has the rows that one process has, and its energy.
    #[test]
    fn any_number_of_rounds() {
        for (points, count) in [([64, 64], 3), ([61, 47], 2), ([130, 24], 4)] {
            let shape = Shape::whole(points[0], points[1]);
            let [columns, half] = [points[0] / 2 + 1, points[1] / 2 + 1];
            let factors: Vec<f64> = (0..columns * half)
                .map(|at| 1.0 + (at % 5) as f64)
                .collect();
            let mut one = Transform::<f64>::new(shape, points[1]);
            one.take();
            let groups = one.groups;
            fill(one.tiles_mut(), groups, 0..points[1]);
            let energy = one.multiply(&factors, true);
            let all = taken(one.tiles(), groups, points[1], columns);
            for round in [
                1,
                3 * PAIR * size_of::<f64>() * BLOCK * points[1],
                MOST_ROUND,
            ] {
                thread::scope(|scope| {
                    for rank in ThreadRanks::new(count) {
                        let (factors, all) = (&factors, &all);
                        scope.spawn(move || {
                            let number = rank.rank();
                            let slabs = Slabs::of_blocks(Arc::new(rank), points[1]);
                            let rows = slabs.own();
                            let own = slabs.groups_of(number, groups);
                            let at = |group: usize| (group * BLOCK).min(columns) * half;
                            let mut here = Transform::<f64>::new(shape, rows.len());
                            here.take();
                            fill(here.tiles_mut(), groups, rows.clone());
                            let factors = &factors[at(own.start)..at(own.end)];
                            let found = here
                                .multiply_across(factors, true, &slabs, round)
                                .expect("all ranks are here");
                            assert_eq!(found.to_bits(), energy.to_bits());
                            let held = taken(here.tiles(), groups, rows.len(), columns);
                            assert!(held == all[rows], "{points:?}, rank {number}, {round}");
                        });
                    }
                });
            }
        }
    }
}
