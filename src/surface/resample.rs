//! A height map on another number of points: by its waves if it is periodic, else by cubics.

use num_complex::Complex;

use super::fourier::{analyse, synthesise};
use crate::grid::Grid;

/// Heights of shape `[points[1], points[0]]` of a periodic map that has `from` points (x, y): the same waves, without
/// those that fewer points do not hold.
pub(super) fn by_waves(heights: &[f64], from: [usize; 2], points: [usize; 2]) -> Vec<f64> {
    let [old, new] = [from, points].map(|points| Grid::new(points, [1.0; 2]));
    let waves = analyse(&old, heights);
    let mut found = vec![Complex::default(); (new.nx / 2 + 1) * new.ny];
    let held = old.nx.min(new.nx);
    for kx in 0..=held / 2 {
        let Some(x) = share(kx, old.nx, new.nx) else {
            continue;
        };
        for ky in 0..old.ny {
            let signed = crate::grid::signed_index(ky, old.ny);
            let Some(y) = share(signed.unsigned_abs() as usize, old.ny, new.ny) else {
                continue;
            };
            let wave = waves[kx * old.ny + ky] * (x * y);
            let place = |k: i64| kx * new.ny + k.rem_euclid(new.ny as i64) as usize;
            found[place(signed)] += wave;
            if y != 1.0 {
                found[place(-signed)] += wave;
            }
        }
    }
    synthesise(&new, found)
}

/// Share of a wave that each of its signs takes: the shortest wave of an even number of points is both; `None` where
/// the new points do not hold it.
fn share(wave: usize, old: usize, new: usize) -> Option<f64> {
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
pub(super) fn by_cubics(heights: &[f64], from: [usize; 2], points: [usize; 2]) -> Vec<f64> {
    let along_x = Weights::new(from[0], points[0]);
    let along_y = Weights::new(from[1], points[1]);
    let rows: Vec<f64> = heights
        .chunks_exact(from[0])
        .flat_map(|row| along_x.apply(|index| row[index]).collect::<Vec<_>>())
        .collect();
    let mut found = vec![0.0; points[0] * points[1]];
    for column in 0..points[0] {
        let values = along_y.apply(|index| rows[index * points[0] + column]);
        for (row, value) in values.enumerate() {
            found[row * points[0] + column] = value;
        }
    }
    found
}

/// Weights of the old points of a line in each new one.
struct Weights {
    count: usize,
    /// First old point, which may lie outside, and the weights from there on.
    points: Vec<(i64, Vec<f64>)>,
}

impl Weights {
    fn new(count: usize, points: usize) -> Self {
        let ratio = count as f64 / points as f64;
        let width = ratio.max(1.0);
        let of_point = |point: usize| {
            let place = (point as f64 + 0.5) * ratio - 0.5;
            let first = (place - 2.0 * width).ceil() as i64;
            let last = (place + 2.0 * width).floor() as i64;
            let weights = (first..=last).map(|old| cubic((old as f64 - place) / width));
            let weights: Vec<f64> = weights.collect();
            let sum: f64 = weights.iter().sum();
            (first, weights.iter().map(|weight| weight / sum).collect())
        };
        Weights {
            count,
            points: (0..points).map(of_point).collect(),
        }
    }

    fn apply<'a>(&'a self, value: impl Fn(usize) -> f64 + 'a) -> impl Iterator<Item = f64> + 'a {
        let last = self.count as i64 - 1;
        let continued = move |index: i64| {
            let nearest = index.clamp(0, last);
            let mirrored = (2 * nearest - index).clamp(0, last);
            if index == nearest {
                value(index as usize)
            } else {
                2.0 * value(nearest as usize) - value(mirrored as usize)
            }
        };
        self.points.iter().map(move |(first, weights)| {
            let places = *first..;
            places
                .zip(weights)
                .map(|(index, weight)| weight * continued(index))
                .sum()
        })
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

    use super::*;

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

    /// Cubics reproduce a plane to rounding, edges included, and a parabola inside; a coarser pixel of white noise
    /// is a mean.
    #[test]
    fn cubics_follow_planes_and_parabolas() {
        let plane = |[nx, ny]: [usize; 2]| -> Vec<f64> {
            let place = |at: usize, count: usize| (at as f64 + 0.5) / count as f64;
            (0..nx * ny)
                .map(|i| 3.0 + 2.0 * place(i % nx, nx) - 5.0 * place(i / nx, ny))
                .collect()
        };
        for (from, to) in [([10, 8], [25, 8]), ([10, 8], [5, 3]), ([2, 9], [7, 4])] {
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
}
