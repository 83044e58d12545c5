//! What the [`plain`](super::plain) text works with and is no step of it: arrays, the law at a point, Fourier
//! transforms, coarser grids.

use std::sync::Arc;

use num_complex::Complex;
use rustfft::{Fft, FftPlanner};

use super::kernel_set::params_under;
use super::load::{Hold, Load};
use super::multilevel;
use super::problem::Problem;
use crate::kernel::Params;

/// `yes` if a condition holds, else `no`.
pub(super) fn choose<T>(condition: bool, yes: T, no: T) -> T {
    if condition { yes } else { no }
}

/// f at each of n points.
pub(super) fn each(n: usize, f: impl FnMut(usize) -> f64) -> Vec<f64> {
    (0..n).map(f).collect()
}

/// <a, b>.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Sum of all.
pub(super) fn sum(a: &[f64]) -> f64 {
    a.iter().sum()
}

/// Root of the sum of squares.
pub(super) fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// The least.
pub(super) fn least(a: &[f64]) -> f64 {
    a.iter().copied().fold(f64::INFINITY, f64::min)
}

/// The greatest.
pub(super) fn most(a: &[f64]) -> f64 {
    a.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// The greatest absolute value.
pub(super) fn largest(a: &[f64]) -> f64 {
    most(a).max(-least(a))
}

/// A problem under a load.
pub(super) struct Contact<'a> {
    pub(super) problem: &'a Problem,
    load: &'a Load,
    pub(super) params: Params,
    /// h.
    pub(super) heights: Vec<f64>,
    /// Whether a point belongs to the surface, not to the pad.
    pub(super) in_domain: Vec<bool>,
    /// Whether it has a wall.
    pub(super) wall: Vec<bool>,
    /// Factor on the law: that of an adhesion map, 0 on the pad.
    factor: Vec<f64>,
    pub(super) fourier: Fourier,
    /// The coarser grids of the preconditioner, each of half the points each way.
    pub(super) coarser: Vec<Coarse>,
    /// The prescribed mean pressure; `None` under a prescribed mean gap.
    pub(super) mean_pressure: Option<f64>,
}

impl<'a> Contact<'a> {
    pub(super) fn new(problem: &'a Problem, load: &'a Load) -> Self {
        let ones = vec![1.0; problem.grid.len()];
        let factor = problem.law_factor.as_ref().unwrap_or(&ones);
        let inside = problem.padded(&ones, 0.0);
        let in_domain: Vec<bool> = inside.iter().map(|&inside| inside > 0.0).collect();
        let wall = problem.law.has_wall();
        let halvings = multilevel::halvings(problem);
        let finer = |k: usize| problem.shape.points.map(|points| points >> k);
        Contact {
            params: params_under(problem, load, f64::EPSILON),
            heights: problem.padded_heights().into(),
            wall: in_domain.iter().map(|&inside| inside && wall).collect(),
            in_domain,
            factor: problem.padded(factor, 0.0),
            fourier: Fourier::new(problem.shape.points),
            coarser: (0..halvings).map(|k| Coarse::new(finer(k))).collect(),
            mean_pressure: match load.hold {
                Hold::Pressure(mean_pressure) => Some(mean_pressure),
                Hold::Gap(_) => None,
            },
            problem,
            load,
        }
    }

    /// Whether the law has a wall.
    pub(super) fn has_wall(&self) -> bool {
        self.problem.law.has_wall()
    }

    /// K at a wave; at q = 0 the stiffness of a spring, 0 without one.
    fn stiffness(&self, q: [usize; 2]) -> f64 {
        if q == [0, 0] {
            self.load.zero_stiffness
        } else {
            self.problem.stiffness.at(q[0], q[1])
        }
    }

    /// K*u.
    pub(super) fn stiffness_times(&self, u: &[f64]) -> Vec<f64> {
        self.fourier.filter(u, |q| self.stiffness(q))
    }

    /// 1/K at a wave; at q = 0 the compliance of the control.
    pub(super) fn compliance(&self, q: [usize; 2]) -> f64 {
        if q == [0, 0] {
            self.load.zero_compliance
        } else {
            1.0 / self.stiffness(q)
        }
    }

    /// A share of 1/K at a wave of the coarsest grid: half over a wall; at q = 0 the compliance of the control.
    pub(super) fn long_compliance(&self, q: [usize; 2]) -> f64 {
        let share = choose(q == [0, 0], 1.0, multilevel::coarsest_share(self.problem));
        share * self.compliance(q)
    }

    /// The factor of a wave that smooths the share of free points.
    pub(super) fn smoothing(&self, q: [usize; 2]) -> f64 {
        multilevel::smoothing(self.problem, q)
    }

    /// Sum of the values at the four neighbours of a point; the grid wraps round.
    pub(super) fn neighbours(&self, values: &[f64], i: usize) -> f64 {
        let [nx, ny] = self.problem.shape.points;
        let (x, y) = (i % nx, i / nx);
        let at = |x: usize, y: usize| values[y % ny * nx + x % nx];
        at(x, y + ny - 1) + at(x, y + 1) + at(x + nx - 1, y) + at(x + 1, y)
    }

    /// sigma(g) at a point.
    pub(super) fn traction(&self, i: usize, gap: f64) -> f64 {
        choose(
            self.in_domain[i],
            self.factor[i] * self.problem.law.traction(gap),
            0.0,
        )
    }

    /// V(g) at a point.
    pub(super) fn energy(&self, i: usize, gap: f64) -> f64 {
        choose(
            self.in_domain[i],
            self.factor[i] * self.problem.law.energy(gap),
            0.0,
        )
    }

    /// k: below the gap of its largest tension sigma_max the smooth law works in the variable
    /// v = g - (sigma_max - sigma(g))/k, in which it is no steeper than k.
    pub(super) fn k(&self) -> f64 {
        self.params.smooth_stiffness
    }

    /// D = max(0, sigma'(g)) of the smooth law; 0 at a wall.
    pub(super) fn hardening(&self, i: usize, gap: f64) -> f64 {
        let slope = self.factor[i] * self.problem.law.slope(gap);
        choose(self.has_wall(), 0.0, slope.max(0.0))
    }

    /// D = max(0, -sigma'(g)) at a wall; 0 of the smooth law.
    pub(super) fn softening(&self, i: usize, gap: f64) -> f64 {
        let slope = self.factor[i] * self.problem.law.slope(gap);
        choose(self.wall[i], (-slope).max(0.0), 0.0)
    }

    /// S = k/(k + D): dg = S dv; 1 at a wall, where v is g.
    pub(super) fn share(&self, i: usize, gap: f64) -> f64 {
        self.k() / (self.k() + self.hardening(i, gap))
    }

    /// v at a gap.
    pub(super) fn variable(&self, i: usize, gap: f64) -> f64 {
        let law = self.problem.law;
        let missing = self.factor[i] * law.peak_tension() - self.traction(i, gap);
        choose(gap < law.peak_gap(), gap - missing / self.k(), gap)
    }

    /// The gap at a v, by bisection: v rises with the gap and is nowhere above it.
    pub(super) fn gap_at(&self, i: usize, v: f64) -> f64 {
        let (mut low, mut high) = (v, v.max(self.problem.law.peak_gap()));
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high || middle.is_nan() {
                return middle;
            }
            let below = self.variable(i, middle) < v;
            (low, high) = choose(below, (middle, high), (low, middle));
        }
    }

    /// What each point takes of a change of the mean gap: its own gap at a wall, S without one.
    pub(super) fn mean_gap_weight(&self, gap: &[f64]) -> Vec<f64> {
        let at = |i: usize| choose(self.has_wall(), gap[i], self.share(i, gap[i]));
        each(gap.len(), at)
    }
}

/// Two-dimensional transforms of `[rows, width]` values.
pub(super) struct Fourier {
    points: [usize; 2],
    /// Along x, along y; forwards and back.
    forward: [Arc<dyn Fft<f64>>; 2],
    inverse: [Arc<dyn Fft<f64>>; 2],
}

impl Fourier {
    /// Transforms of so many points along x and along y.
    pub(super) fn new(points: [usize; 2]) -> Self {
        let mut planner = FftPlanner::new();
        Fourier {
            points,
            forward: points.map(|n| planner.plan_fft_forward(n)),
            inverse: points.map(|n| planner.plan_fft_inverse(n)),
        }
    }

    /// The values with each wave times a factor, given for the absolute values of its two indices.
    pub(super) fn filter(&self, values: &[f64], factor: impl Fn([usize; 2]) -> f64) -> Vec<f64> {
        let [width, rows] = self.points;
        let mut waves: Vec<Complex<f64>> = values.iter().map(Complex::from).collect();
        self.transform(&mut waves, &self.forward);
        for (i, wave) in waves.iter_mut().enumerate() {
            let (kx, ky) = (i % width, i / width);
            *wave *= factor([kx.min(width - kx), ky.min(rows - ky)]) / values.len() as f64;
        }
        self.transform(&mut waves, &self.inverse);
        waves.iter().map(|wave| wave.re).collect()
    }

    fn transform(&self, waves: &mut [Complex<f64>], [along_x, along_y]: &[Arc<dyn Fft<f64>>; 2]) {
        let [width, _] = self.points;
        for row in waves.chunks_exact_mut(width) {
            along_x.process(row);
        }
        for x in 0..width {
            let mut column: Vec<_> = waves.iter().skip(x).step_by(width).copied().collect();
            along_y.process(&mut column);
            for (y, value) in column.into_iter().enumerate() {
                waves[y * width + x] = value;
            }
        }
    }
}

/// A grid of half the points of a finer one each way.
pub(super) struct Coarse {
    /// Its transforms.
    pub(super) fourier: Fourier,
    fine: [usize; 2],
}

/// Finer points along a cell.
const RATIO: usize = 2;

impl Coarse {
    /// The coarse grid of a fine one.
    pub(super) fn new(fine: [usize; 2]) -> Self {
        Coarse {
            fourier: Fourier::new(fine.map(|n| n / RATIO)),
            fine,
        }
    }

    /// Mean of the fine values in each cell.
    pub(super) fn average(&self, fine: &[f64]) -> Vec<f64> {
        self.gather(fine, |neighbours| vec![(neighbours[0].0, 1.0)])
    }

    /// The adjoint of the interpolation, per cell area.
    pub(super) fn restrict(&self, fine: &[f64]) -> Vec<f64> {
        self.gather(fine, |neighbours| neighbours.to_vec())
    }

    fn gather(
        &self,
        fine: &[f64],
        weights: impl Fn([(usize, f64); 4]) -> Vec<(usize, f64)>,
    ) -> Vec<f64> {
        let cell_area = (RATIO * RATIO) as f64;
        let mut coarse = vec![0.0; fine.len() / (RATIO * RATIO)];
        for (i, value) in fine.iter().enumerate() {
            for (cell, weight) in weights(self.neighbours(i)) {
                coarse[cell] += weight * value / cell_area;
            }
        }
        coarse
    }

    /// Bilinear interpolation between the middles of the cells.
    pub(super) fn interpolate(&self, coarse: &[f64]) -> Vec<f64> {
        let at = |i: usize| {
            self.neighbours(i)
                .map(|(cell, weight)| weight * coarse[cell])
        };
        (0..self.fine[0] * self.fine[1])
            .map(|i| at(i).iter().sum())
            .collect()
    }

    /// The four cells around a fine point with their bilinear weights, its own first.
    fn neighbours(&self, i: usize) -> [(usize, f64); 4] {
        let [nx, ny] = self.fine;
        let width = nx / RATIO;
        let along = |place: usize, points: usize| {
            let cells = points / RATIO;
            let (own, within) = (place / RATIO, place % RATIO);
            let from_centre = (within as f64 + 0.5) / RATIO as f64 - 0.5;
            let step = if from_centre < 0.0 { cells - 1 } else { 1 };
            let other = (own + step) % cells;
            [(own, 1.0 - from_centre.abs()), (other, from_centre.abs())]
        };
        let (x, y) = (along(i % nx, nx), along(i / nx, ny));
        let at = |(x, y): ((usize, f64), (usize, f64))| (y.0 * width + x.0, x.1 * y.1);
        [(x[0], y[0]), (x[1], y[0]), (x[0], y[1]), (x[1], y[1])].map(at)
    }
}
