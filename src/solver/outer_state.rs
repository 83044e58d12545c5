//! The state of a contact in double precision, beside a solver whose iterations run in single.

use super::kernel_set::{KernelSet, params_of_problem};
use super::load::{Hold, Load};
use super::mean_gap::HeightsPressure;
use super::problem::Problem;
use crate::backend::long_field::LongField;
use crate::backend::{Backend, BackendError, Field, Level, Response, Share, Spectrum};
use crate::kernel::{Gate, Params, Scalars, Status, displacement, mean_gap, refinement, scalar};

/// Gap and pressure in double precision, and the evaluation of their residual.
pub(super) struct OuterState {
    backend: Box<dyn Backend + Send>,
    places: Places,
    /// K times the heights, where a mean gap is kept by linearity.
    heights_pressure: Option<HeightsPressure>,
    kernels: KernelSet,
    params: Params,
}

/// Its fields and spectra.
#[derive(Clone, Copy)]
struct Places {
    level: Level,
    law_factor: Option<Field>,
    heights: Field,
    gap: Field,
    pressure: Field,
    /// A residual on its way to the iterations, or a correction from there.
    between: Field,
    stiffness: Spectrum,
    /// Gap of the outer state, where the iterations run.
    base: Field,
}

/// Plans the further fields of mixed precision, to count them: the outer state on `double`, and its gap beside the
/// fields of a solver planned on `iterating`.
pub fn plan_outer_state(
    double: &mut dyn Backend,
    iterating: &mut dyn Backend,
    problem: &Problem,
    load: &Load,
) {
    let places = Places::plan(double, iterating, Level(0), problem);
    if matches!(load.hold, Hold::Gap(_)) && KernelSet::new(problem).is_linear() {
        HeightsPressure::plan(double, places.level);
    }
    places.rest(double);
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
            between: backend.field(level, "between"),
            stiffness: problem.spectrum(backend, level, "stiffness", Response::Stiffness),
            base: iterating.field(fine, "outer_gap"),
        }
    }

    fn rest(&self, backend: &mut dyn Backend) {
        backend.release(self.between);
        backend.release_work(self.level);
    }
}

impl OuterState {
    /// Lets go of the work space of its evaluation, until the next one.
    pub fn rest_work(&mut self) {
        self.backend.release_work(self.places.level);
    }

    /// Lets go of the field and the work space that only its evaluation needs, until the next one.
    pub fn rest(&mut self) {
        self.places.rest(&mut *self.backend);
    }

    /// Plans the outer state of a problem on a backend of double precision, and a copy of its gap where the
    /// iterations run.
    pub fn new(
        mut backend: Box<dyn Backend + Send>,
        iterating: &mut dyn Backend,
        fine: Level,
        problem: &Problem,
    ) -> Self {
        let places = Places::plan(&mut *backend, iterating, fine, problem);
        let heights = problem.padded_heights();
        backend.write(places.heights, &heights);
        let params = params_of_problem(problem, backend.epsilon());
        OuterState {
            places,
            heights_pressure: None,
            kernels: KernelSet::new(problem),
            params,
            backend,
        }
    }

    pub fn transforms(&self) -> f64 {
        self.backend.transforms()
    }

    pub fn set_heights(&mut self, heights: &[f64]) {
        self.backend.write(self.places.heights, heights);
    }

    /// Copies the heights to the iterations.
    pub fn hand_heights(
        &mut self,
        iterating: &mut dyn Backend,
        heights: Field,
    ) -> Result<(), BackendError> {
        iterating.copy_from(heights, &mut *self.backend, self.places.heights)
    }

    /// Sets the factors on the law's tension, one a grid point.
    pub fn set_law_factor(&mut self, problem: &Problem, factor: &[f64]) {
        if let Some(field) = self.places.law_factor {
            self.backend.write(field, &problem.padded(factor, 0.0));
        }
    }

    pub fn set_gap(&mut self, gap: &[f64]) {
        self.backend.write(self.places.gap, gap);
    }

    pub fn gap(&mut self) -> Result<LongField<f64>, BackendError> {
        self.backend.read(self.places.gap)
    }

    /// K*(g + h), as last evaluated.
    pub fn pressure(&mut self) -> Result<LongField<f64>, BackendError> {
        self.backend.read(self.places.pressure)
    }

    /// Begins a load, with the params of the iterations.
    pub fn begin(&mut self, load: &Load, tolerance: f64, iterating: &Params) {
        let (prescribed_mean_gap, mean_pressure, offset) = match load.hold {
            Hold::Pressure(pressure) => (false, pressure, 0.0),
            Hold::Gap(target) => (true, 0.0, target),
        };
        self.params = Params {
            epsilon: self.params.epsilon,
            tolerance,
            ..*iterating
        };
        self.backend.set_params(&self.params);
        self.backend
            .set_zero_mode(self.places.stiffness, load.zero_stiffness);
        if prescribed_mean_gap && self.kernels.is_linear() {
            let fields = [self.places.heights, self.places.pressure];
            self.heights_pressure
                .get_or_insert_with(|| HeightsPressure::plan(&mut *self.backend, self.places.level))
                .find(&mut *self.backend, fields, self.places.stiffness);
        }
        self.backend.set_scalars(&Scalars {
            offset,
            ..Scalars::start(mean_pressure, false)
        });
    }

    /// Pressures and stopping measure of the present gap.
    pub fn evaluate(&mut self) -> Result<Scalars, BackendError> {
        let backend = &mut *self.backend;
        let fields = [self.places.gap, self.places.heights];
        backend.run(&displacement::LOAD_DISPLACEMENT, self.places.level, &fields);
        backend.multiply(self.places.stiffness, false, Gate::Always);
        backend.run(
            &displacement::STORE_FIELD,
            self.places.level,
            &[self.places.pressure],
        );
        self.measure()
    }

    /// Stopping measure of the present gap, whose pressures are evaluated.
    pub fn measure(&mut self) -> Result<Scalars, BackendError> {
        let backend = &mut *self.backend;
        let mut scalars = backend.scalars()?;
        scalars.status = Status::Running;
        backend.set_scalars(&scalars);
        let fields = [self.places.gap, self.places.pressure];
        if self.params.prescribed_mean_gap {
            backend.run(self.kernels.mean_gap.balance, self.places.level, &fields);
            backend.scalar(&mean_gap::MEAN_PRESSURE);
        }
        backend.run(self.kernels.residual, self.places.level, &fields);
        backend.scalar(&scalar::TEST_CONVERGENCE);
        backend.scalars()
    }

    /// The numerator of the stopping measure that rounding in double precision leaves.
    pub fn rounding_floor(&self, end: &Scalars) -> f64 {
        scalar::rounding_floor(&self.params, end)
    }

    /// Takes the gap that iterations have found.
    pub fn copy_gap(
        &mut self,
        iterating: &mut dyn Backend,
        gap: Field,
    ) -> Result<(), BackendError> {
        self.backend.clear(self.places.gap);
        self.add(iterating, gap)
    }

    /// Adds a correction that iterations have found, and brings the gap back to the prescribed mean.
    pub fn add(
        &mut self,
        iterating: &mut dyn Backend,
        correction: Field,
    ) -> Result<(), BackendError> {
        let Places {
            level,
            gap,
            between,
            ..
        } = self.places;
        let backend = &mut *self.backend;
        backend.copy_from(between, iterating, correction)?;
        // A solid with a hardness has no outer state.
        let Some(kernels) = self.kernels.outer else {
            return Ok(());
        };
        backend.run(kernels.add_correction, level, &[between, gap]);
        if self.params.prescribed_mean_gap {
            backend.scalar(&mean_gap::RESTORE_OUTER_MEAN_GAP);
            backend.run(kernels.restore_gap, level, &[gap]);
        }
        Ok(())
    }

    /// Hands the present gap to where the iterations run, and its residual, as last evaluated, to `there`, the pressure from
    /// which its correction starts. Returns the field of the gap.
    pub fn hand_outer_state(
        &mut self,
        iterating: &mut dyn Backend,
        there: Field,
    ) -> Result<Field, BackendError> {
        let Places {
            level,
            gap,
            pressure,
            between,
            base,
            ..
        } = self.places;
        let backend = &mut *self.backend;
        backend.run(
            &refinement::OUTER_RESIDUAL,
            level,
            &[gap, pressure, between],
        );
        iterating.copy_from(base, backend, gap)?;
        iterating.copy_from(there, backend, between)?;
        Ok(base)
    }

    /// Hands y + K h - p, the residual as it was handed over less the pressure of the present gap, to where the iterations
    /// run. There it takes the place of K h: the pressure of a correction c, which starts at y, and K (g + c) differ by it. The
    /// difference taken in double precision keeps the digits that single precision would lose.
    pub fn hand_rigid(
        &mut self,
        iterating: &mut dyn Backend,
        rigid: Field,
    ) -> Result<(), BackendError> {
        let Some(heights_pressure) = &self.heights_pressure else {
            return Ok(());
        };
        let Places {
            level,
            pressure,
            between,
            ..
        } = self.places;
        let fields = [heights_pressure.field(), pressure, between];
        self.backend
            .run(&refinement::OUTER_PRESSURE, level, &fields);
        iterating.copy_from(rigid, &mut *self.backend, between)
    }

    /// Copies the present gap to the iterations.
    pub fn hand_gap(
        &mut self,
        iterating: &mut dyn Backend,
        gap: Field,
    ) -> Result<(), BackendError> {
        iterating.copy_from(gap, &mut *self.backend, self.places.gap)
    }

    /// `<values, K*values>/2` with this value of K at the zero wavevector. The next solve sets that of its
    /// load again.
    pub fn energy_of(
        &mut self,
        share: &Share,
        values: &[f64],
        zero_mode: f64,
    ) -> Result<f64, BackendError> {
        let (gap, pressure) = (self.gap()?, self.pressure()?);
        let backend = &mut *self.backend;
        backend.set_zero_mode(self.places.stiffness, zero_mode);
        backend.write(self.places.gap, values);
        backend.run(
            &displacement::LOAD_FIELD,
            self.places.level,
            &[self.places.gap],
        );
        backend.multiply(self.places.stiffness, false, Gate::Always);
        backend.run(
            &displacement::STORE_FIELD,
            self.places.level,
            &[self.places.pressure],
        );
        let answer = backend.read(self.places.pressure)?;
        backend.write(self.places.gap, &gap);
        backend.write(self.places.pressure, &pressure);
        Ok(0.5 * share.product(values, &answer))
    }
}
