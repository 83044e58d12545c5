//! A gap moved rigidly to a prescribed mean, without driving points deep into the repulsion of Lennard-Jones.
//!
//! A law without a wall repels like r^9. A step of the mean gap as long as its range would take points in
//! contact to tractions that no solid can carry: in single precision no other part of the residual has
//! a digit beside them, and no descent leads out. Such points stop where the repulsion equals the largest
//! pressure that the solid can be pressed to, and the others move further, so that the mean is kept.

use std::ops::DerefMut;

use super::problem::Problem;
use crate::law::{Cohesion, Law};

/// Newton steps that find how far the others move. Each but the last stops more points; on rough surfaces
/// about five are enough.
const NEWTON_STEPS: usize = 60;

impl Problem {
    /// This gap over all solved points of a periodic grid, reduced, moved rigidly to this mean; for a law
    /// without a wall, points stop at the least gap that any pressure reaches.
    pub fn moved_to<F: DerefMut<Target = [f64]> + Sync>(&self, mut gap: F, target: f64) -> F {
        let count = self.shape.len();
        let mean = self.share.sum(&gap) / count as f64;
        let mut moved = target - mean;
        let Some(floors) = self.nearest_gaps(target) else {
            gap.iter_mut().for_each(|g| *g += moved);
            return gap;
        };
        let floor = |i: usize| floors[i % floors.len()];
        // The mean of max(g + moved, floor) is convex in the move, and too large at the first one: Newton's
        // method comes down to the root from above.
        for _ in 0..NEWTON_STEPS {
            let width = self.shape.points[0];
            let rows = self.share.rows().len();
            let [excess, free] = self.share.sums(rows, |row, [excess, free]| {
                let line = gap.iter().enumerate().skip(row * width).take(width);
                for (i, g) in line {
                    let (lifted, rigid) = (floor(i), g + moved);
                    *free += f64::from(u8::from(rigid > lifted));
                    *excess += rigid.max(lifted) - target;
                }
            });
            if free == count as f64 {
                break;
            }
            if free == 0.0 {
                // Nothing is left to move: the surfaces stand parallel.
                gap.fill(target);
                return gap;
            }
            let next = moved - excess / free;
            if next >= moved {
                break;
            }
            moved = next;
        }
        for (i, g) in gap.iter_mut().enumerate() {
            *g = (*g + moved).max(floor(i));
        }
        gap
    }

    /// The least gaps that any pressure of this contact reaches at a mean gap of `target`: one for each point
    /// if the law varies from point to point, else one for all; `None` for a law with a wall.
    fn nearest_gaps(&self, target: f64) -> Option<Vec<f64>> {
        let Law::LennardJones(law) = self.law else {
            return None;
        };
        let (lowest, highest) = (self.heights.lowest(), self.heights.highest());
        // The pressure of the stiffest wave with all the roughness, plus that of flats at this mean gap.
        let pressure = self.stiffness_max() * (highest - lowest);
        let at = |factor: f64| {
            let law = law.times(factor);
            law.repelling(pressure - law.traction(target).min(0.0))
        };
        Some(match &self.law_factor {
            Some(factors) => factors.iter().map(|&factor| at(factor)).collect(),
            None => vec![at(1.0)],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Boundary, Grid};
    use crate::law::LennardJones;

    /// Of 8 x 8 points, with a range that is short beside the heights.
    fn problem(law: Law) -> Problem {
        let grid = Grid::new([8, 8], [8.0, 8.0]);
        let heights: Vec<f64> = (0..64).map(|i| f64::from(i * 37 % 64) / 32.0).collect();
        Problem::new(grid, Boundary::Periodic, 1.0, &heights, 0.5, law)
    }

    fn lennard_jones() -> Problem {
        problem(Law::LennardJones(LennardJones {
            work_of_adhesion: 1e-4,
            range: 0.05,
        }))
    }

    fn touching(problem: &Problem) -> Vec<f64> {
        let highest = problem.highest();
        problem.heights.iter().map(|h| highest - h).collect()
    }

    fn mean(values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / values.len() as f64
    }

    #[test]
    fn what_stays_out_of_the_core_moves_rigidly() {
        for problem in [lennard_jones(), problem(Law::HardWall)] {
            let gap = touching(&problem);
            // The mean as it is found there, to the last bit.
            let mean = problem.share.sum(&gap) / gap.len() as f64;
            let target = mean + 0.5;
            let moved = target - mean;
            let rigid: Vec<f64> = gap.iter().map(|g| g + moved).collect();
            assert_eq!(problem.moved_to(gap, target), rigid);
        }
    }

    /// 64 gaps near 1 are summed: their mean is good to some tens of roundings.
    #[test]
    fn the_mean_is_held_and_no_point_goes_deeper_than_a_pressure_takes_it() {
        let problem = lennard_jones();
        let range = problem.law.range();
        let gap = touching(&problem);
        let spread = gap.iter().copied().fold(0.0, f64::max);
        let mut left = 0;
        for target in [0.9, 0.5, 0.2, 0.05, 0.0, -0.5 * range, -0.9 * range] {
            let target = if target > 0.0 {
                target * mean(&gap)
            } else {
                target
            };
            let moved = problem.moved_to(gap.clone(), target);
            assert!((mean(&moved) - target).abs() < 1e-13, "{target}");
            let deepest = moved.iter().copied().fold(f64::INFINITY, f64::min);
            let pressure =
                problem.stiffness_max() * spread + (-problem.law.traction(target)).max(0.0);
            assert!(deepest > problem.law.least_gap(), "{target}: {deepest}");
            // The bound on the repulsion is generous by a third and a constant of w/eps.
            let most = 1.5 * pressure + 10.0 * problem.law.peak_tension();
            assert!(
                -problem.law.traction(deepest) <= most,
                "{target}: {deepest}"
            );
            left += moved.iter().filter(|g| **g == deepest).count();
            // Those that are not left move by the same.
            let ways = gap
                .iter()
                .zip(&moved)
                .filter(|(_, g)| **g > deepest)
                .map(|(g, m)| m - g);
            let (low, high) = ways.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), way| {
                (l.min(way), h.max(way))
            });
            assert!(low > high || high - low < 1e-13, "{target}: {low} {high}");
        }
        assert!(left > 64, "{left}: nothing was left at the core");
    }

    /// A tenth of the law repels a tenth as much: its points are left nearer.
    #[test]
    fn a_map_of_the_law_sets_each_point_its_own_bound() {
        let factor: Vec<f64> = (0..64)
            .map(|i| if i % 2 == 0 { 1.0 } else { 0.1 })
            .collect();
        let problem = lennard_jones().with_adhesion_map(factor);
        let gap = touching(&problem);
        let target = 0.2 * mean(&gap);
        let moved = problem.moved_to(gap, target);
        assert!((mean(&moved) - target).abs() < 1e-13);
        let deepest = |odd: usize| {
            let own = moved.iter().skip(odd).step_by(2).copied();
            own.fold(f64::INFINITY, f64::min)
        };
        assert!(deepest(1) < deepest(0), "{} {}", deepest(1), deepest(0));
    }

    /// Flats that no pressure of theirs could hold apart are left to be refused by the caller.
    #[test]
    fn beyond_the_core_the_surfaces_stand_parallel() {
        let problem = lennard_jones();
        let target = -2.0 * problem.law.range();
        let moved = problem.moved_to(touching(&problem), target);
        assert!(moved.iter().all(|g| *g == target), "{moved:?}");
    }
}
