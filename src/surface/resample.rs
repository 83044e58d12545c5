//! A height map on another number of points: by its waves if it is periodic, else by cubics.

use std::ops::RangeInclusive;

use super::across;
use crate::backend::{BackendError, Share};
use crate::grid::signed_index;

/// Heights of the rows that a process holds of a periodic map on other points, `to`: the same waves, without those that fewer
/// points do not hold. `heights` are the rows that it holds of the map.
///
/// # Errors
/// A rank has ended.
pub(super) fn by_waves(
    heights: Vec<f64>,
    from: &Share,
    to: &Share,
) -> Result<Vec<f64>, BackendError> {
    let ([old_nx, old_ny], [nx, ny]) = (from.surface(), to.surface());
    let columns = old_nx.min(nx) / 2 + 1;
    across::bring([from, to], heights, columns, |kx, waves, found| {
        let Some(x) = part(kx, old_nx, nx) else {
            return;
        };
        for (ky, wave) in waves.iter().enumerate() {
            let signed = signed_index(ky, old_ny);
            let Some(y) = part(signed.unsigned_abs() as usize, old_ny, ny) else {
                continue;
            };
            let wave = wave * (x * y);
            let place = |k: i64| k.rem_euclid(ny as i64) as usize;
            found[place(signed)] += wave;
            if y != 1.0 {
                found[place(-signed)] += wave;
            }
        }
    })
}

/// The part of a wave that each of its signs takes: the shortest wave of an even number of points is both; `None` where
/// the new points do not hold it.
fn part(wave: usize, old: usize, new: usize) -> Option<f64> {
    if old == new || 2 * wave < old.min(new) {
        Some(1.0)
    } else if 2 * wave == old && old < new {
        Some(0.5)
    } else {
        None
    }
}

/// The same of a patch: cubic convolution (Keys 1981, doi:10.1109/TASSP.1981.1163711) through the points of pixels
/// that cover it, over as many points as a coarser pixel covers; edges are continued straight.
///
/// # Errors
/// A rank has ended.
pub(super) fn by_cubics(
    heights: &[f64],
    from: &Share,
    to: &Share,
) -> Result<Vec<f64>, BackendError> {
    let [along_x, along_y] = [0, 1].map(|axis| Cubics {
        old: from.surface()[axis],
        new: to.surface()[axis],
    });
    let of_columns: Vec<_> = (0..along_x.new)
        .map(|point| along_x.weights(point))
        .collect();
    // The rows of the map near those of a rank.
    let near = |rank: usize| -> Vec<usize> {
        let rows = to.surface_rows_of(rank);
        let first = rows.clone().map(|row| *along_y.near(row).start()).min();
        let last = rows.map(|row| *along_y.near(row).end()).max();
        first
            .zip(last)
            .map_or(Vec::new(), |(first, last)| (first..=last).collect())
    };
    let own = to.surface_rows();
    let asked = near(to.rank());
    let first = asked.first().copied().unwrap_or(0);
    // The weights of each of them in the rows here.
    let mut of_rows = vec![Vec::new(); asked.len()];
    for (here, row) in own.clone().enumerate() {
        let (start, weights) = along_y.weights(row);
        for (old, weight) in of_rows[start - first..].iter_mut().zip(weights) {
            old.push((here, weight));
        }
    }
    let mut found = vec![0.0; to.surface_len()];
    let mut line = vec![0.0; along_x.new];
    let take = |row: usize, values: &[f64]| {
        for (value, (start, weights)) in line.iter_mut().zip(&of_columns) {
            let pairs = values[*start..].iter().zip(weights);
            *value = pairs.map(|(value, weight)| weight * value).sum();
        }
        for (here, weight) in &of_rows[row - first] {
            let new = &mut found[here * line.len()..(here + 1) * line.len()];
            for (height, value) in new.iter_mut().zip(&line) {
                *height += weight * value;
            }
        }
    };
    let held = |rank: usize| from.surface_rows_of(rank);
    from.fetch_each(heights, along_x.old, held, near, take)?;
    Ok(found)
}

/// The points of a line through cubics of its old ones.
struct Cubics {
    old: usize,
    new: usize,
}

impl Cubics {
    /// The place of a new point among the old, and over how many the cubic goes.
    fn place(&self, point: usize) -> [f64; 2] {
        let ratio = self.old as f64 / self.new as f64;
        [(point as f64 + 0.5) * ratio - 0.5, ratio.max(1.0)]
    }

    /// The old points under the cubic of a new one, which may lie outside.
    fn under(&self, point: usize) -> RangeInclusive<i64> {
        let [place, width] = self.place(point);
        let first = (place - 2.0 * width).ceil() as i64;
        first..=(place + 2.0 * width).floor() as i64
    }

    /// An old point; of one outside the nearest, and the mirror image in it.
    fn continued(&self, index: i64) -> [usize; 2] {
        let last = self.old as i64 - 1;
        let nearest = index.clamp(0, last);
        [nearest, (2 * nearest - index).clamp(0, last)].map(|index| index as usize)
    }

    /// The old points on which a new one depends.
    fn near(&self, point: usize) -> RangeInclusive<usize> {
        let under = self.under(point);
        // An edge is continued from as far inside as the cubic reaches outside.
        let ends = [*under.start(), *under.end()].map(|end| self.continued(end));
        let ends = ends.as_flattened();
        ends.iter().copied().min().unwrap_or(0)..=ends.iter().copied().max().unwrap_or(0)
    }

    /// The first of these, and their weights.
    fn weights(&self, point: usize) -> (usize, Vec<f64>) {
        let [place, width] = self.place(point);
        let of_old = |old: i64| cubic((old as f64 - place) / width);
        let sum: f64 = self.under(point).map(of_old).sum();
        let near = self.near(point);
        let first = *near.start();
        let mut weights = vec![0.0; near.count()];
        for index in self.under(point) {
            let weight = of_old(index) / sum;
            let [nearest, mirrored] = self.continued(index);
            if index == nearest as i64 {
                weights[nearest - first] += weight;
            } else {
                weights[nearest - first] += 2.0 * weight;
                weights[mirrored - first] -= weight;
            }
        }
        (first, weights)
    }
}

/// Keys' cubic of third order, a = -1/2.
fn cubic(x: f64) -> f64 {
    let x = x.abs();
    if x <= 1.0 {
        (1.5 * x - 2.5) * x * x + 1.0
    } else if x < 2.0 {
        ((-0.5 * x + 2.5) * x - 4.0) * x + 2.0
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;
    use std::sync::Arc;
    use std::thread;

    use super::*;
    use crate::backend::Shape;
    use crate::backend::ranks::ThreadRanks;

    fn whole([nx, ny]: [usize; 2]) -> Share {
        Share::whole(Shape::whole(nx, ny))
    }

    fn by_waves(heights: &[f64], from: [usize; 2], to: [usize; 2]) -> Vec<f64> {
        super::by_waves(heights.to_vec(), &whole(from), &whole(to)).expect("one process")
    }

    fn by_cubics(heights: &[f64], from: [usize; 2], to: [usize; 2]) -> Vec<f64> {
        super::by_cubics(heights, &whole(from), &whole(to)).expect("one process")
    }

    fn waves([nx, ny]: [usize; 2]) -> Vec<f64> {
        (0..nx * ny)
            .map(|index| {
                let (x, y) = (
                    (index % nx) as f64 / nx as f64,
                    (index / nx) as f64 / ny as f64,
                );
                1.0 + (TAU * (2.0 * x + y)).sin() + 0.5 * (TAU * (x - 3.0 * y)).cos()
            })
            .collect()
    }

    fn off(found: &[f64], expected: &[f64]) -> f64 {
        assert_eq!(found.len(), expected.len());
        let pairs = found.iter().zip(expected);
        pairs.fold(0.0, |most, (a, b)| most.max((a - b).abs()))
    }

    /// Waves that both grids hold are the same on both, finer and coarser, even and odd.
    #[test]
    fn waves_stay_the_same_on_any_grid() {
        for (from, to) in [
            ([16, 12], [32, 30]),
            ([15, 9], [21, 10]),
            ([32, 30], [16, 9]),
            ([16, 12], [16, 24]),
            ([9, 8], [9, 8]),
        ] {
            let found = by_waves(&waves(from), from, to);
            assert!(off(&found, &waves(to)) < 1e-12, "{from:?} {to:?}");
        }
        // The shortest wave of even points is a cosine, and stays one.
        let found = by_waves(&[1.0, -1.0, 1.0, -1.0], [4, 1], [8, 1]);
        let cosine: Vec<f64> = (0..8).map(|i| (TAU * f64::from(i) / 4.0).cos()).collect();
        assert!(off(&found, &cosine) < 1e-12, "{found:?}");
    }

    /// Cubics reproduce a plane to rounding on finer grids and on ones coarser by a whole number, edges included, and a parabola inside; a coarser pixel of white noise
    /// is a mean.
    #[test]
    fn cubics_follow_planes_and_parabolas() {
        let plane = |[nx, ny]: [usize; 2]| -> Vec<f64> {
            let place = |at: usize, count: usize| (at as f64 + 0.5) / count as f64;
            (0..nx * ny)
                .map(|i| 3.0 + 2.0 * place(i % nx, nx) - 5.0 * place(i / nx, ny))
                .collect()
        };
        for (from, to) in [([10, 8], [25, 8]), ([10, 9], [5, 3]), ([4, 9], [7, 3])] {
            let found = by_cubics(&plane(from), from, to);
            assert!(off(&found, &plane(to)) < 1e-12, "{from:?} {to:?}");
        }
        let parabola: Vec<f64> = (0..12).map(|i| (f64::from(i) + 0.5).powi(2)).collect();
        let found = by_cubics(&parabola, [12, 1], [36, 1]);
        for (index, height) in found.iter().enumerate().take(27).skip(9) {
            let exact = ((index as f64 + 0.5) / 3.0).powi(2);
            assert!((height - exact).abs() < 1e-12, "{index}: {height} {exact}");
        }
        let alternating: Vec<f64> = (0..64)
            .map(|i| if i % 2 == 0 { 1.0 } else { -1.0 })
            .collect();
        let found = by_cubics(&alternating, [64, 1], [16, 1]);
        assert!(
            found[4..12].iter().all(|height| height.abs() < 0.05),
            "{found:?}"
        );
    }

    /// On any number of ranks, and with sides of any number of points, the rows have the bits of one process.
    #[test]
    fn ranks_find_the_rows_of_one_process() {
        for (from, to) in [
            ([12, 37], [31, 53]),
            ([31, 53], [12, 37]),
            ([7, 90], [9, 3]),
            ([9, 3], [7, 90]),
            ([16, 40], [16, 40]),
            ([1, 48], [5, 24]),
            ([24, 1], [48, 33]),
            ([24, 33], [12, 1]),
        ] {
            let mut heights = waves(from);
            for (index, height) in heights.iter_mut().enumerate() {
                *height += ((index * 37) % 11) as f64;
            }
            let alone = [by_waves(&heights, from, to), by_cubics(&heights, from, to)];
            for count in [2, 3, 8] {
                thread::scope(|scope| {
                    for rank in ThreadRanks::new(count) {
                        let (alone, heights) = (&alone, &heights);
                        scope.spawn(move || {
                            let old = Shape::whole(from[0], from[1]);
                            let old = Share::on_ranks(old, Some(Arc::new(rank)));
                            let new = old.of(Shape::whole(to[0], to[1]));
                            let rows = old.surface_rows();
                            let own = &heights[rows.start * from[0]..rows.end * from[0]];
                            let found = [
                                super::by_waves(own.to_vec(), &old, &new),
                                super::by_cubics(own, &old, &new),
                            ];
                            let rows = new.surface_rows();
                            for (found, alone) in found.into_iter().zip(alone) {
                                let bits = |height: &f64| height.to_bits();
                                let alone = &alone[rows.start * to[0]..rows.end * to[0]];
                                let found = found.expect("all ranks");
                                assert!(
                                    found.iter().map(bits).eq(alone.iter().map(bits)),
                                    "{from:?} {to:?} on {count}"
                                );
                            }
                        });
                    }
                });
            }
        }
    }
}
