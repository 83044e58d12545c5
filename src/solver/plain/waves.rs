//! Convolutions of plain arrays, and the long waves of the two-band preconditioner.

use std::sync::Arc;

use num_complex::Complex;
use rustfft::{Fft, FftPlanner};

use crate::elastic::wave_stiffness;
use crate::grid::{Boundary, Grid};
use crate::law::Law;
use crate::solver::problem::Problem;

/// Pixels in the length beyond which waves count as long.
const LONG_WAVES: f64 = 8.0;
/// Pixels over which the share of free points is smoothed.
const SMOOTHED: f64 = 4.0;
/// Fewest coarse points each way.
const FEWEST_COARSE: usize = 8;

/// l = exp(-(8 q dx)^2), the share of a wave that counts as long.
pub fn long_share(wavenumber: f64) -> f64 {
    (-(LONG_WAVES * wavenumber).powi(2)).exp()
}

/// Two-dimensional transforms of `[rows, width]` values.
pub struct Fourier {
    width: usize,
    rows: usize,
    /// Along x, along y; forwards and back.
    forward: [Arc<dyn Fft<f64>>; 2],
    inverse: [Arc<dyn Fft<f64>>; 2],
}

impl Fourier {
    pub fn new(width: usize, rows: usize) -> Self {
        let mut planner = FftPlanner::new();
        Fourier {
            width,
            rows,
            forward: [width, rows].map(|n| planner.plan_fft_forward(n)),
            inverse: [width, rows].map(|n| planner.plan_fft_inverse(n)),
        }
    }

    /// A real, even factor at every wavevector, of the indices of its absolute components.
    pub fn factors(&self, of: impl Fn(usize, usize) -> f64) -> Vec<f64> {
        let fold = |k: usize, n: usize| k.min(n - k);
        (0..self.width * self.rows)
            .map(|i| {
                of(
                    fold(i % self.width, self.width),
                    fold(i / self.width, self.rows),
                )
            })
            .collect()
    }

    /// The values convolved with what has these factors.
    pub fn convolve(&self, values: &[f64], factors: &[f64]) -> Vec<f64> {
        let mut waves: Vec<Complex<f64>> = values.iter().map(Complex::from).collect();
        self.transform(&mut waves, &self.forward);
        for (wave, factor) in waves.iter_mut().zip(factors) {
            *wave *= factor / values.len() as f64;
        }
        self.transform(&mut waves, &self.inverse);
        waves.iter().map(|wave| wave.re).collect()
    }

    fn transform(&self, waves: &mut [Complex<f64>], [along_x, along_y]: &[Arc<dyn Fft<f64>>; 2]) {
        for row in waves.chunks_exact_mut(self.width) {
            along_x.process(row);
        }
        for x in 0..self.width {
            let mut column: Vec<_> = waves.iter().skip(x).step_by(self.width).copied().collect();
            along_y.process(&mut column);
            for (y, value) in column.into_iter().enumerate() {
                waves[y * self.width + x] = value;
            }
        }
    }
}

/// The second band: `P[Wc ((l/K) * (Wc R r))]` on a grid of fewer points, with R restricting, P = R^T
/// interpolating and Wc the squared, smoothed share of free points.
pub struct LongWaves {
    ratio: usize,
    fine: [usize; 2],
    fourier: Fourier,
    smoothing: Vec<f64>,
    compliance: Vec<f64>,
}

impl LongWaves {
    /// For a hard wall on a periodic grid that can be coarsened; else `None`.
    pub fn new(problem: &Problem, zero_compliance: f64) -> Option<Self> {
        let [nx, ny] = problem.shape.points;
        if problem.law != Law::HardWall || problem.boundary != Boundary::Periodic {
            return None;
        }
        let divides = |ratio: &usize| nx.is_multiple_of(*ratio) && ny.is_multiple_of(*ratio);
        let ratio = [4, 2].into_iter().find(divides)?;
        let [width, rows] = [nx / ratio, ny / ratio];
        if width < FEWEST_COARSE || rows < FEWEST_COARSE {
            return None;
        }
        let grid = Grid::new([width, rows], [problem.grid.lx, problem.grid.ly]);
        let pixel = problem.scales.lateral;
        let fourier = Fourier::new(width, rows);
        let smoothing =
            fourier.factors(|kx, ky| (-(SMOOTHED * grid.wavenumber(kx, ky) * pixel).powi(2)).exp());
        let mut compliance = fourier.factors(|kx, ky| {
            let q = grid.wavenumber(kx, ky);
            long_share(q * pixel) / (wave_stiffness(q, problem.layer.as_ref()) * pixel)
        });
        compliance[0] = zero_compliance;
        Some(LongWaves {
            ratio,
            fine: [nx, ny],
            fourier,
            smoothing,
            compliance,
        })
    }

    /// The long-wave part of z.
    pub fn times(&self, residual: &[f64], free: &[bool]) -> Vec<f64> {
        let cell_area = (self.ratio * self.ratio) as f64;
        let count = self.compliance.len();
        let (mut restricted, mut share) = (vec![0.0; count], vec![0.0; count]);
        for (i, &r) in residual.iter().enumerate() {
            let neighbours = self.neighbours(i);
            for (cell, weight) in neighbours {
                restricted[cell] += weight * r / cell_area;
            }
            share[neighbours[0].0] += f64::from(u8::from(free[i])) / cell_area;
        }
        let share = self.fourier.convolve(&share, &self.smoothing);
        let weight: Vec<f64> = share.iter().map(|m| m.clamp(0.0, 1.0).powi(2)).collect();
        let weighed = |values: &[f64]| -> Vec<f64> {
            values.iter().zip(&weight).map(|(v, w)| v * w).collect()
        };
        let long = weighed(
            &self
                .fourier
                .convolve(&weighed(&restricted), &self.compliance),
        );
        (0..residual.len())
            .map(|i| {
                self.neighbours(i)
                    .iter()
                    .map(|(cell, w)| w * long[*cell])
                    .sum()
            })
            .collect()
    }

    /// The four cells around a fine point with their bilinear weights, its own first.
    fn neighbours(&self, i: usize) -> [(usize, f64); 4] {
        let [nx, ny] = self.fine;
        let width = nx / self.ratio;
        let along = |place: usize, points: usize| {
            let cells = points / self.ratio;
            let (own, within) = (place / self.ratio, place % self.ratio);
            let from_centre = (within as f64 + 0.5) / self.ratio as f64 - 0.5;
            let other = if from_centre < 0.0 {
                own + cells - 1
            } else {
                own + 1
            } % cells;
            [(own, 1.0 - from_centre.abs()), (other, from_centre.abs())]
        };
        let (x, y) = (along(i % nx, nx), along(i / nx, ny));
        let at = |(x, y): ((usize, f64), (usize, f64))| (y.0 * width + x.0, x.1 * y.1);
        [(x[0], y[0]), (x[1], y[0]), (x[0], y[1]), (x[1], y[1])].map(at)
    }
}
