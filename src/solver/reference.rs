//! The state of a contact in double precision, beside a solver whose iterations run in single.

use super::contact::{Hold, Load};
use super::kernel_set::{KernelSet, fixed_params};
use super::problem::Problem;
use crate::backend::{Backend, BackendError, Field, Level, Spectrum};
use crate::kernel::{Gate, Params, Scalars, Status, common, scalar};
use crate::law::Law;

/// Gap and pressure in double precision, and the evaluation of their residual.
pub(super) struct Reference {
    backend: Box<dyn Backend + Send>,
    places: Places,
    kernels: &'static KernelSet,
    params: Params,
    /// Factors on the law's tension over the grid, where it is not the same everywhere.
    law_factor: Option<Vec<f64>>,
}

/// What is held for it.
struct Places {
    level: Level,
    law_factor: Option<Field>,
    heights: Field,
    gap: Field,
    pressure: Field,
    stiffness: Spectrum,
    /// Gap and residual of the base, where the iterations run.
    base: [Field; 2],
}

/// Plans what mixed precision holds besides: on `double` the state, beside the `iterating` fields of a
/// solver that is planned there the base of its corrections. To count it.
pub fn plan_reference(double: &mut dyn Backend, iterating: &mut dyn Backend, problem: &Problem) {
    Places::plan(double, iterating, Level(0), problem);
}

impl Places {
    fn plan(
        backend: &mut dyn Backend,
        iterating: &mut dyn Backend,
        fine: Level,
        problem: &Problem,
    ) -> Self {
        let level = backend.level("fine", problem.shape);
        let law_factor = problem.law_factor.as_ref().map(|factor| {
            let field = backend.field(level, "law_factor");
            backend.write(field, &problem.padded(factor, 0.0));
            backend.set_law_factor(field);
            field
        });
        Places {
            level,
            law_factor,
            heights: backend.field(level, "heights"),
            gap: backend.field(level, "gap"),
            pressure: backend.field(level, "pressure"),
            stiffness: backend.spectrum(level, "stiffness", &problem.stiffness),
            base: [
                iterating.field(fine, "base_gap"),
                iterating.field(fine, "base_residual"),
            ],
        }
    }
}

impl Reference {
    /// Plans the state of a problem on a backend of double precision, and its base beside the
    /// iterations on theirs.
    pub fn new(
        mut backend: Box<dyn Backend + Send>,
        iterating: &mut dyn Backend,
        fine: Level,
        problem: &Problem,
    ) -> Self {
        let places = Places::plan(&mut *backend, iterating, fine, problem);
        backend.write(places.heights, &problem.padded(&problem.heights, 0.0));
        Reference {
            places,
            kernels: KernelSet::of(problem),
            params: fixed_params(problem, backend.epsilon()),
            law_factor: problem.law_factor.clone(),
            backend,
        }
    }

    /// Gap and residual of the base, where the iterations run.
    pub fn base(&self) -> [Field; 2] {
        self.places.base
    }

    pub fn transforms(&self) -> f64 {
        self.backend.transforms()
    }

    pub fn set_heights(&mut self, heights: &[f64]) {
        self.backend.write(self.places.heights, heights);
    }

    /// Sets the factors on the law's tension, one a grid point.
    pub fn set_law_factor(&mut self, problem: &Problem, factor: Vec<f64>) {
        if let Some(field) = self.places.law_factor {
            self.backend.write(field, &problem.padded(&factor, 0.0));
            self.law_factor = Some(factor);
        }
    }

    pub fn set_gap(&mut self, gap: &[f64]) {
        self.backend.write(self.places.gap, gap);
    }

    pub fn gap(&mut self) -> Result<Vec<f64>, BackendError> {
        self.backend.read(self.places.gap)
    }

    /// K*(g + h), as last evaluated.
    pub fn pressure(&mut self) -> Result<Vec<f64>, BackendError> {
        self.backend.read(self.places.pressure)
    }

    /// Takes a load.
    pub fn begin(&mut self, load: &Load, tolerance: f64, may_detach: bool) {
        let (fixed_gap, mean_pressure, offset) = match load.hold {
            Hold::Pressure(pressure) => (false, pressure, 0.0),
            Hold::Gap(target) => (true, 0.0, target),
        };
        self.params.fixed_gap = fixed_gap;
        self.params.tolerance = tolerance;
        self.params.may_detach = may_detach;
        self.backend.set_params(&self.params);
        self.backend
            .set_zero_mode(self.places.stiffness, load.zero_stiffness);
        self.backend.set_scalars(&Scalars {
            offset,
            ..Scalars::start(mean_pressure, false)
        });
    }

    /// Pressures and stopping measure of the present gap.
    pub fn evaluate(&mut self) -> Result<Scalars, BackendError> {
        let backend = &mut *self.backend;
        let mut scalars = backend.scalars()?;
        scalars.status = Status::Running;
        backend.set_scalars(&scalars);
        let fields = [self.places.gap, self.places.heights];
        backend.forward(&common::LOAD_DISPLACEMENT, self.places.level, &fields);
        backend.multiply(self.places.stiffness, false, Gate::Always);
        backend.backward(
            &common::STORE_PRESSURE,
            self.places.level,
            &[self.places.pressure],
        );
        let fields = [self.places.gap, self.places.pressure];
        if self.params.fixed_gap {
            backend.sweep(self.kernels.balance, self.places.level, &fields);
            backend.scalar(self.kernels.balance_scalar);
        }
        backend.sweep(self.kernels.residual, self.places.level, &fields);
        backend.scalar(&scalar::JUDGE);
        backend.scalars()
    }

    /// The numerator of the stopping measure that rounding in double precision leaves.
    pub fn rounding_floor(&self, end: &Scalars) -> f64 {
        scalar::rounding_floor(&self.params, end)
    }

    /// y = p + mean_pressure + sigma(g) at each point, as last evaluated; without a law on the pad.
    pub fn residual(
        &mut self,
        problem: &Problem,
        gap: &[f64],
        mean_pressure: f64,
    ) -> Result<Vec<f64>, BackendError> {
        let mut residual = self.pressure()?;
        residual.iter_mut().for_each(|y| *y += mean_pressure);
        if problem.law == Law::HardWall {
            return Ok(residual);
        }
        let [width, _] = problem.shape.points;
        let [nx, ny] = problem.shape.surface;
        let rows = residual
            .chunks_exact_mut(width)
            .zip(gap.chunks_exact(width));
        for (row, (residual, gap)) in rows.take(ny).enumerate() {
            for (column, (y, &g)) in residual.iter_mut().zip(gap).take(nx).enumerate() {
                let factor = self
                    .law_factor
                    .as_ref()
                    .map_or(1.0, |factor| factor[row * nx + column]);
                *y += factor * problem.law.traction(g);
            }
        }
        Ok(residual)
    }

    /// `<values, K*values>/2` with this value of K at the zero wavevector. The next solve sets it to
    /// its load's again.
    pub fn energy_of(&mut self, values: &[f64], zero_mode: f64) -> Result<f64, BackendError> {
        let (gap, pressure) = (self.gap()?, self.pressure()?);
        let backend = &mut *self.backend;
        backend.set_zero_mode(self.places.stiffness, zero_mode);
        backend.write(self.places.gap, values);
        backend.forward(&common::LOAD_FIELD, self.places.level, &[self.places.gap]);
        backend.multiply(self.places.stiffness, false, Gate::Always);
        backend.backward(
            &common::STORE_PRESSURE,
            self.places.level,
            &[self.places.pressure],
        );
        let answer = backend.read(self.places.pressure)?;
        backend.write(self.places.gap, &gap);
        backend.write(self.places.pressure, &pressure);
        Ok(0.5 * values.iter().zip(&answer).map(|(u, p)| u * p).sum::<f64>())
    }
}
