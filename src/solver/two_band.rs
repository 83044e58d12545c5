//! The two-band preconditioner of the hard wall, with which the number of iterations hardly depends on the
//! grid.
//!
//! The inverse stiffness carries long waves across contacts, where the solid cannot move. So it is
//! applied as it is to short waves only; long waves are taken on a coarse grid, weighted by the share of
//! free points there:
//! `z = ((1-l)/K)*yF + P[Wc ((l/K)*(Wc R yF))]`, with `l = exp(-(8 q dx)^2)`.

use super::kernel_set::{KernelSet, RetainSet};
use super::problem::Problem;
use crate::backend::{Backend, Factors, Field, Level, Response, Shape, Spectrum};
use crate::elastic::{Stiffness, wave_stiffness};
use crate::grid::{Boundary, Grid};
use crate::kernel::{Gate, displacement, two_band};
use crate::law::Law;

/// Fewest coarse points each way for which the second band saves time.
pub(super) const FEWEST_COARSE: usize = 8;

/// Pixels in the length beyond which waves count as long.
pub(super) const LONG_WAVES: f64 = 8.0;

/// Pixels over which the share of free points is smoothed.
pub(super) const SMOOTHED: f64 = 4.0;

/// The coarse level of the preconditioner and its fields.
pub(super) struct TwoBand {
    fine: Level,
    level: Level,
    /// The projected residual on the fine level.
    residual: Field,
    restricted: Field,
    share: Field,
    weight: Field,
    long_waves: Field,
    smoothing: Spectrum,
    compliance: Spectrum,
    /// The kernels that retain the projected residual.
    pub retain: RetainSet,
}

/// l at a wave number, with the pixel in the same unit.
fn long_share(wavenumber: f64, pixel: f64) -> f64 {
    (-(LONG_WAVES * wavenumber * pixel).powi(2)).exp()
}

impl TwoBand {
    /// Plans the coarse level for a hard wall on a periodic grid that can be coarsened.
    pub fn plan(backend: &mut dyn Backend, fine: Level, problem: &Problem) -> Option<Self> {
        let [nx, ny] = problem.shape.points;
        if problem.law != Law::HardWall || problem.boundary != Boundary::Periodic {
            return None;
        }
        let retain = KernelSet::new(problem).retain?;
        let ratio = [4, 2].into_iter().find(|ratio| {
            nx % ratio == 0
                && ny % ratio == 0
                && backend.suits(Shape::whole(nx / ratio, ny / ratio))
        })?;
        if nx / ratio < FEWEST_COARSE || ny / ratio < FEWEST_COARSE {
            return None;
        }
        let grid = Grid::new([nx / ratio, ny / ratio], [problem.grid.lx, problem.grid.ly]);
        let level = backend.level("coarse", Shape::whole(grid.nx, grid.ny));
        let pixel = problem.scales.lateral;
        let tabulate = |value: &dyn Fn(f64) -> f64| -> Vec<f64> {
            if problem.is_sketch() {
                return Vec::new();
            }
            (0..=grid.nx / 2)
                .flat_map(|kx| (0..=grid.ny / 2).map(move |ky| (kx, ky)))
                .map(|(kx, ky)| value(grid.wavenumber(kx, ky)))
                .collect()
        };
        let smoothing = tabulate(&|q| (-(SMOOTHED * q * pixel).powi(2)).exp());
        let compliance = tabulate(&|q| {
            if q > 0.0 {
                long_share(q, pixel) / (wave_stiffness(q, problem.layer.as_ref()) * pixel)
            } else {
                0.0
            }
        });
        Some(TwoBand {
            retain,
            fine,
            level,
            residual: backend.field(fine, "projected_residual"),
            restricted: backend.field(level, "restricted"),
            share: backend.field(level, "share"),
            weight: backend.field(level, "weight"),
            long_waves: backend.field(level, "long_waves"),
            smoothing: backend.spectrum(level, "smoothing", Factors::Table(&smoothing)),
            compliance: backend.spectrum(level, "long_compliance", Factors::Table(&compliance)),
        })
    }

    /// Makes the compliance of the first band, `(1 - l)/K`, on the fine level.
    pub fn short_waves(
        &self,
        backend: &mut dyn Backend,
        name: &'static str,
        problem: &Problem,
    ) -> Spectrum {
        let (grid, pixel) = (&problem.grid, problem.scales.lateral);
        match &problem.stiffness {
            // Of a half-space K is q/2 times the pixel.
            &Stiffness::HalfSpace(half_space) => {
                let short = Response::ShortCompliance(2.0 * LONG_WAVES);
                backend.spectrum(self.fine, name, Factors::HalfSpace(half_space, short))
            }
            Stiffness::Table(stiffness) => {
                let values: Vec<f64> = (0..=grid.nx / 2)
                    .flat_map(|kx| (0..=grid.ny / 2).map(move |ky| (kx, ky)))
                    .zip(stiffness)
                    .map(|((kx, ky), &stiffness)| match stiffness > 0.0 {
                        true => (1.0 - long_share(grid.wavenumber(kx, ky), pixel)) / stiffness,
                        false => 0.0,
                    })
                    .collect();
                backend.spectrum(self.fine, name, Factors::Table(&values))
            }
        }
    }

    /// Sets the compliance of the zero mode.
    pub fn set_zero_mode(&self, backend: &mut dyn Backend, value: f64) {
        backend.set_zero_mode(self.compliance, value);
    }

    /// The field of the projected residual, which the kernels that load it retain.
    pub fn residual(&self) -> Field {
        self.residual
    }

    /// Records the preconditioned residual z of the projected one that was retained and whose rows are
    /// transformed; `direction` where the mean gap is prescribed.
    pub fn descend(
        &self,
        backend: &mut dyn Backend,
        previous_residual: Field,
        direction: Option<Field>,
        short_waves: Spectrum,
    ) {
        let level = self.level;
        let fields = [self.restricted, self.share, self.residual];
        backend.run(&two_band::COARSEN, level, &fields);
        backend.run(&displacement::LOAD_FIELD_AHEAD, level, &[self.share]);
        backend.multiply(self.smoothing, false, Gate::Ahead);
        let fields = [self.restricted, self.weight];
        backend.run(&two_band::WEIGH, level, &fields);
        backend.multiply(self.compliance, false, Gate::Ahead);
        let fields = [self.weight, self.long_waves];
        backend.run(&two_band::STORE_WEIGHTED, level, &fields);
        backend.multiply(short_waves, false, Gate::Ahead);
        let own = [self.residual, previous_residual];
        match direction {
            Some(direction) => {
                let fields = [own[0], own[1], direction, self.long_waves];
                backend.run(&two_band::MEAN_GAP_TWO_BAND_DESCENT, self.fine, &fields);
            }
            None => {
                let fields = [own[0], own[1], self.long_waves];
                backend.run(&two_band::TWO_BAND_DESCENT, self.fine, &fields);
            }
        }
    }
}
