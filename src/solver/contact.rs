//! A solver of one problem: what it plans, how a solve of a load begins, and when it ends.

use std::borrow::Cow;
use std::sync::Arc;

use super::MakeBackend;
use super::borrowed::{BackendRef, ProblemRef};
use super::coarse_start;
use super::kernel_set::{KernelSet, params_of_problem, params_under};
use super::load::{Hold, Load, Outcome, Start};
use super::mean_gap::HeightsPressure;
use super::multilevel::{Multilevel, sticks};
use super::outer_state::OuterState;
use super::problem::Problem;
use crate::backend::long_field::LongField;
use crate::backend::{Backend, BackendError, Field, Level, Response, Spectrum, host_fields};
use crate::grid::Boundary;
use crate::kernel::{Params, Scalars, Status, scalar};
use crate::law::{Cohesion, Law};

/// An evaluation of K*(g + h) that holds as long as gap and heights stay as they are.
#[derive(Clone, Copy, Debug)]
struct Evaluated {
    /// The stiffness of the zero mode.
    zero_stiffness: f64,
    /// Whether the solver holds its pressure; else that of another process did.
    held: bool,
}

/// Solves one problem, load after load.
pub struct ContactSolver<'a> {
    pub(super) backend: BackendRef<'a>,
    pub(super) problem: ProblemRef<'a>,
    pub(super) level: Level,
    pub(super) heights: Field,
    /// Whether the field of the heights holds them: corrections of a state in double precision ask for none.
    pub(super) has_heights: bool,
    pub(super) gap: Field,
    pub(super) pressure: Field,
    pub(super) direction: Field,
    pub(super) previous_residual: Field,
    /// K times the heights, where a mean gap is kept by linearity.
    pub(super) heights_pressure: Option<HeightsPressure>,
    /// Factors on the law's tension, where it varies from point to point or with time.
    law_factor: Option<Field>,
    /// These factors over the grid, unless they are the problem's own.
    present_factor: Option<Vec<f64>>,
    /// The trial step of a law whose change of variable makes it costly.
    pub(super) step: Option<Field>,
    pub(super) stiffness: Spectrum,
    /// 1/K as the preconditioner: without levels, and far from a solution with adhesion over a wall.
    pub(super) preconditioner: Option<Spectrum>,
    /// The compliance of all waves, for a scene with conductance.
    pub(super) compliance: Option<Spectrum>,
    pub(super) levels: Option<Multilevel>,
    /// Whether the preconditioner is 1/K for now.
    pub(super) exact: bool,
    pub(super) kernels: KernelSet,
    pub(super) params: Params,
    /// The outer state in double precision of iterative refinement; made at its first use.
    pub(super) outer: Option<OuterState>,
    /// The pressure of the present gap, if it has been evaluated.
    evaluated: Option<Evaluated>,
    /// Transforms of the coarse starts, less those that another process counted.
    helped_by: f64,
    /// What the history of a viscoelastic solid adds to its displacement, over all solved points; empty for
    /// an elastic solid.
    pub(super) offset: Vec<f64>,
    /// Mean of it.
    pub(super) mean_offset: f64,
    /// Depths by which plastic indentation has lowered the heights, over all held solved points; `None` if it
    /// has not.
    pub(super) plastic_depths: Option<Vec<f64>>,
}

/// Rounds, lost trials and long searches included, that a solve may take for each iteration allowed.
pub const ROUNDS_PER_ITERATION: usize = 4;

/// Transforms of an evaluation of K*(g + h).
const EVALUATION_TRANSFORMS: f64 = 2.0;
/// A solve has stalled by drift of the pressures if the residual that is carried along is below this share
/// of the fresh one.
const DRIFTED: f64 = 0.5;
/// Restarts from fresh pressures after such a stall.
const REFRESHES: usize = 4;
/// Restarts in a row from fresh pressures that have not converged as those carried along have: further ones find the same
/// rounding.
const RESTARTS: usize = 20;

impl<'a> ContactSolver<'a> {
    /// Plans a problem on a backend: fields, spectra and kernels for its law, and no others.
    pub fn new(backend: &'a mut (dyn Backend + Send), problem: &'a Problem) -> Self {
        ContactSolver::plan(BackendRef::Borrowed(backend), ProblemRef::Borrowed(problem))
    }

    /// The same of a solver that holds both, and so may be kept for as long as one likes.
    pub fn holding(
        backend: Box<dyn Backend + Send>,
        problem: Arc<Problem>,
    ) -> ContactSolver<'static> {
        ContactSolver::plan(BackendRef::Own(backend), ProblemRef::Shared(problem))
    }

    fn plan(mut held: BackendRef<'a>, held_problem: ProblemRef<'a>) -> Self {
        let (backend, problem): (&mut dyn Backend, &Problem) = (&mut *held, &held_problem);
        let level = backend.level("fine", problem.shape);
        let heights = backend.field(level, "heights");
        let gap = backend.field(level, "gap");
        let pressure = backend.field(level, "pressure");
        let direction = backend.field(level, "direction");
        let previous_residual = backend.field(level, "previous_residual");
        let has_wall = problem.law.has_wall();
        let step = (!has_wall).then(|| backend.field(level, "step"));
        let law_factor = problem.law_factor.as_ref().map(|factor| {
            let field = backend.field(level, "law_factor");
            // A pad has no law.
            backend.write(field, &problem.padded(factor, 0.0));
            backend.set_law_factor(field);
            field
        });
        let stiffness = problem.spectrum(backend, level, "stiffness", Response::Stiffness);
        let levels = Multilevel::plan(backend, level, problem);
        let exact = levels.is_none() || sticks(problem);
        let preconditioner =
            exact.then(|| problem.spectrum(backend, level, "preconditioner", Response::Compliance));
        let compliance = problem
            .conducts
            .then(|| problem.spectrum(backend, level, "compliance", Response::Compliance));
        let params = params_of_problem(problem, backend.epsilon());
        // Energies are asked for before the first load as well: a solid may recover in a step of its own.
        backend.set_params(&params);
        let kernels = KernelSet::new(problem);
        let mut solver = ContactSolver {
            backend: held,
            problem: held_problem,
            level,
            heights,
            gap,
            pressure,
            direction,
            previous_residual,
            heights_pressure: None,
            has_heights: false,
            law_factor,
            present_factor: None,
            step,
            stiffness,
            preconditioner,
            compliance,
            levels,
            exact,
            kernels,
            params,
            outer: None,
            evaluated: None,
            helped_by: 0.0,
            offset: Vec::new(),
            mean_offset: 0.0,
            plastic_depths: None,
        };
        solver.rest();
        solver
    }

    /// Lets go of the fields and of the work space that only iterations need, until the next one.
    pub fn rest(&mut self) {
        let residuals = self.levels.iter().flat_map(Multilevel::residuals);
        let own = [self.direction, self.previous_residual];
        for field in own.into_iter().chain(self.step).chain(residuals) {
            self.backend.release(field);
        }
        self.backend.release_work(self.level);
        if let Some(outer) = &mut self.outer {
            outer.rest();
        }
    }

    /// The problem being solved.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// Relative rounding error of the fields' numbers.
    pub fn epsilon(&self) -> f64 {
        self.params.epsilon
    }

    /// Real two-dimensional transforms so far, those on coarser grids in proportion to their points.
    pub fn transforms(&self) -> f64 {
        let outer = self.outer.as_ref().map_or(0.0, OuterState::transforms);
        self.backend.transforms() + self.helped_by + outer
    }

    /// The gap over all held solved points, reduced.
    pub fn gap(&mut self) -> Result<LongField<f64>, BackendError> {
        match &mut self.outer {
            Some(outer) => outer.gap(),
            None => self.backend.read(self.gap),
        }
    }

    /// Sets the gap from which [`Start::Present`] starts, as [`ContactSolver::gap`] gave it.
    pub fn set_gap(&mut self, gap: &[f64]) {
        if let Some(outer) = self.outer() {
            outer.set_gap(gap);
        }
        self.evaluated = None;
        self.backend.write(self.gap, gap);
    }

    /// The stiffness of the zero mode under which the pressure of the present gap has been evaluated; `None` if
    /// a start from it evaluates anew.
    pub fn evaluated_under(&self) -> Option<f64> {
        self.evaluated.map(|evaluated| evaluated.zero_stiffness)
    }

    /// Says that another process had evaluated the pressure of the gap that was set, which counted its transforms.
    pub fn set_evaluated_under(&mut self, zero_stiffness: Option<f64>) {
        self.evaluated = zero_stiffness.map(|zero_stiffness| Evaluated {
            zero_stiffness,
            held: false,
        });
    }

    /// The elastic pressure K*(g + h) over all solved points, reduced, without the mean pressure.
    pub fn elastic_pressure(&mut self) -> Result<LongField<f64>, BackendError> {
        match &mut self.outer {
            Some(outer) => outer.pressure(),
            None => self.backend.read(self.pressure),
        }
    }

    /// Sets the factors on the law's tension, one a held grid point; the problem must have some. `None` sets
    /// the problem's own.
    pub fn set_law_factor(&mut self, factor: Option<Vec<f64>>) {
        let problem = self.problem.clone();
        if let (Some(field), Some(own)) = (self.law_factor, &problem.law_factor) {
            let values = factor.as_ref().unwrap_or(own);
            self.backend.write(field, &problem.padded(values, 0.0));
            if self.outer().is_some()
                && let Some(outer) = &mut self.outer
            {
                outer.set_law_factor(&problem, values);
            }
            self.present_factor = factor;
        }
    }

    /// The factors that were set; `None` if they are the problem's own.
    pub fn law_factor(&self) -> Option<&[f64]> {
        self.present_factor.as_deref()
    }

    /// The gap at which the undeformed surfaces first touch, scaled or shifted to a prescribed mean gap.
    fn undeformed(&self, load: &Load) -> LongField<f64> {
        let own = &self.problem.heights;
        let mut heights = host_fields::made(own.len(), own.by_point());
        if let Some(depths) = &self.plastic_depths {
            let depths = self.problem.surface_part(depths);
            heights
                .iter_mut()
                .zip(depths)
                .for_each(|(h, depth)| *h -= depth);
        }
        let highest = self.problem.share.greatest_of(&heights);
        let mut gap = heights;
        host_fields::change(&mut gap, |_, h| *h = highest - *h);
        if let Hold::Gap(target) = load.hold {
            let sum = self.problem.share.surface_sum_by(&gap, |g| g);
            let mean = sum / self.problem.shape.surface_len() as f64;
            if target >= mean {
                host_fields::change(&mut gap, |_, g| *g += target - mean);
            } else if target <= 0.0
                && (self.problem.hardness.is_some() || !self.problem.law.has_wall())
            {
                // Pressed in beyond closure: the solid is indented everywhere, or the Lennard-Jones surfaces
                // stand parallel where they repel.
                gap.fill(target);
            } else {
                host_fields::change(&mut gap, |_, g| *g *= target / mean);
            }
        }
        gap
    }

    /// Prepares a solve: the load, the start, and the pressures that belong to it.
    ///
    /// With an outer state the present gap is that state's, which is handed in before.
    pub fn begin(
        &mut self,
        load: &Load,
        start: &Start,
        tolerance: f64,
        careful: bool,
    ) -> Result<(), BackendError> {
        self.hold_heights()?;
        self.set_load(load, tolerance);
        let (prescribed_mean_gap, mean_pressure) = match load.hold {
            Hold::Pressure(pressure) => (false, pressure),
            Hold::Gap(_) => (true, 0.0),
        };
        if prescribed_mean_gap {
            self.begin_mean_gap();
        }
        let mut scalars = Scalars::start(mean_pressure, careful);
        if let Hold::Gap(target) = load.hold {
            scalars.offset = target;
        }
        self.backend.set_scalars(&scalars);
        match start {
            Start::Present => {}
            Start::Gap(gap) => self.backend.write(self.gap, gap),
            Start::Cold => {
                let gap = self.undeformed(load);
                let gap = match self.problem.boundary {
                    Boundary::Periodic => gap,
                    Boundary::Free => self.problem.padded(&gap, 0.0).into(),
                };
                self.backend.write(self.gap, &gap);
            }
        }
        self.evaluate_start(load, start)?;
        self.ready();
        self.choose_preconditioner()
    }

    /// Sets the numbers of a load.
    pub(super) fn set_load(&mut self, load: &Load, tolerance: f64) {
        // A prescribed mean gap needs K h without the mean of the heights, hence K = 0 at q = 0.
        debug_assert!(!matches!(load.hold, Hold::Gap(_)) || load.zero_stiffness == 0.0);
        self.backend.set_outer_gap(None);
        self.params = params_under(&self.problem, load, self.params.epsilon);
        self.params.tolerance = tolerance;
        self.backend.set_params(&self.params);
        self.backend
            .set_zero_mode(self.stiffness, load.zero_stiffness);
        if let Some(levels) = &self.levels {
            levels.set_zero_mode(&mut *self.backend, load.zero_compliance);
        }
        if let Some(spectrum) = self.preconditioner {
            self.backend.set_zero_mode(spectrum, load.zero_compliance);
        }
        self.exact = self.levels.is_none();
    }

    /// The pressure of the gap from which a solve starts.
    fn evaluate_start(&mut self, load: &Load, start: &Start) -> Result<(), BackendError> {
        if self.is_evaluated(load, start) {
            return Ok(());
        }
        self.refresh()
    }

    /// Whether the pressure of the gap from which a solve starts is held: the last solve has evaluated that of its own gap.
    /// Where another process has, its transforms count and those of evaluating it anew do not.
    pub(super) fn is_evaluated(&mut self, load: &Load, start: &Start) -> bool {
        let stays = matches!((start, load.hold), (Start::Present, Hold::Pressure(_)));
        let evaluated = self.evaluated.take();
        match evaluated.filter(|last| stays && last.zero_stiffness == load.zero_stiffness) {
            None => false,
            Some(last) => {
                if !last.held {
                    self.helped_by -= EVALUATION_TRANSFORMS;
                }
                last.held
            }
        }
    }

    /// Says that no pressure has been evaluated.
    pub(super) fn forget_evaluated(&mut self) {
        self.evaluated = None;
    }

    /// Says that the pressure of the present gap has been evaluated under a load.
    pub(super) fn set_evaluated(&mut self, load: &Load) {
        self.evaluated = Some(Evaluated {
            zero_stiffness: load.zero_stiffness,
            held: true,
        });
    }

    /// Solves a load. `watch` sees the scalars whenever the host looks and may end the solve by
    /// returning false.
    #[allow(clippy::too_many_arguments)]
    pub fn solve(
        &mut self,
        load: &Load,
        start: &Start,
        tolerance: f64,
        max_iterations: usize,
        careful: bool,
        make_backend: MakeBackend,
        watch: &mut dyn FnMut(&Scalars) -> bool,
    ) -> Result<Outcome, BackendError> {
        let helped = match start {
            // The coarse grids do not have the plastic depths.
            Start::Cold if self.plastic_depths.is_none() && self.backend.starts_coarse() => {
                coarse_start::gap(&self.problem, load, make_backend, watch)?
            }
            _ => None,
        };
        let start = match helped {
            Some((gap, transforms)) => {
                self.helped_by += transforms;
                Cow::Owned(Start::Gap(gap))
            }
            None => Cow::Borrowed(start),
        };
        if self.outer().is_some() {
            return self.solve_in_rounds(load, start, tolerance, max_iterations, careful, watch);
        }
        self.begin(load, &start, tolerance, careful)?;
        // It is not held beside the fields of the iterations.
        drop(start);
        let (mut rounds, mut iterations, mut refreshed) = (0, 0, 0);
        let (mut best, mut restarts) = (f64::INFINITY, 0);
        loop {
            let (recorded, scalars) = self.advance(max_iterations.saturating_sub(iterations))?;
            rounds += recorded;
            iterations = scalars.iterations as usize;
            let mut status = scalars.status;
            let out_of_iterations =
                iterations >= max_iterations || rounds >= ROUNDS_PER_ITERATION * max_iterations;
            let stopped = !watch(&scalars);
            if status == Status::Running && !out_of_iterations && !stopped {
                continue;
            }
            let end = self.evaluate()?;
            let at_floor = end.numerator <= scalar::rounding_floor(&self.params, &end);
            match status {
                // The residual that is carried along has converged, the fresh one has not: continue, unless
                // only rounding of the gap is left, which the fresh one alone contains.
                Status::Converged if end.status != Status::Converged && !at_floor => {
                    restarts = if end.residual < best { 0 } else { restarts + 1 };
                    best = best.min(end.residual);
                    let goes_on = restarts < RESTARTS && !out_of_iterations && !stopped;
                    if goes_on && end.status == Status::Running {
                        self.ready();
                        continue;
                    }
                    status = end.status;
                }
                // The pressures that are carried along balance, those of the gap do not: each step rounds
                // both. Restarting from fresh pressures leaves the error of a single rounding.
                Status::Stalled
                    if !at_floor
                        && scalars.residual <= DRIFTED * end.residual
                        && refreshed < REFRESHES
                        && !out_of_iterations
                        && !stopped
                        && end.status == Status::Running =>
                {
                    refreshed += 1;
                    self.ready();
                    continue;
                }
                Status::Stalled | Status::Running
                    if end.residual <= tolerance || (status == Status::Stalled && at_floor) =>
                {
                    status = Status::Converged;
                }
                _ => {}
            }
            self.set_evaluated(load);
            return Ok(Outcome::new(
                status,
                end.iterations as usize,
                end.residual,
                end.mean_pressure,
            ));
        }
    }

    /// The preconditioner's zero mode under a prescribed mean pressure without a spring.
    pub fn pressure_compliance(problem: &Problem, mean_pressure: f64) -> f64 {
        let softest = 1.0 / problem.stiffness_min();
        match problem.law {
            Law::HardWall if mean_pressure != 0.0 => (problem.rms_height() / mean_pressure.abs())
                .min(100.0 * softest)
                .max(softest),
            // Between flat surfaces the slope of the law takes up a pressure. It is far stiffer than a wave: a
            // step by the wave's compliance would pass the gap of the largest tension and leave the branch.
            Law::LennardJones(law) if problem.rms_height() == 0.0 => {
                softest.min(1.0 / Cohesion::slope(&law, 0.0))
            }
            _ => softest,
        }
    }
}
