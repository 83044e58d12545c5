//! A prescribed value about to be solved, as passed to an effect that solves it in its own way.

use super::control::Controller;
use super::evaluation::Evaluation;
use super::row::State;
use super::setup::Setup;
use super::step::{SolvedStep, finish, misses, solve};
use crate::backend::BackendError;
use crate::backend::long_field::LongField;
use crate::kernel::{Scalars, Status};
use crate::law::imbalance;
use crate::solver::{ContactSolver, Hold, Load, MakeBackend, Outcome, Problem, Start};

/// Further solves of a state whose pressures do not add up to the load.
const CLOSER: usize = 3;
/// The tolerance of each over that of the one before.
const CLOSER_BY: f64 = 0.01;

/// Further starts of a solve that stalls, each of which ends after some ten iterations if it stalls as well: a soft solid that has
/// jumped from a few spots to contact around a few holes took six.
const FURTHER_STARTS: usize = 40;

/// A step to be solved, with its solver.
pub(crate) struct Attempt<'a> {
    /// The scene.
    pub setup: &'a Setup,
    /// The problem of the step.
    pub problem: &'a Problem,
    /// Translates values of the path to loads.
    pub controller: &'a Controller<'a>,
    /// The solver.
    pub solver: &'a mut ContactSolver<'static>,
    /// The prescribed value.
    pub value: f64,
    /// How long the step takes, s.
    pub duration: f64,
    /// Whether the solver's gap belongs to a solved step.
    pub loaded: bool,
    /// To which tolerance it is solved.
    pub tolerance: f64,
    /// Where solvers on coarser grids get their backends from.
    pub make_backend: MakeBackend<'a>,
    /// Sees each iteration and says whether to continue.
    pub watch: &'a mut dyn FnMut(&Scalars) -> bool,
}

/// Whether surfaces that are pressed together are found apart: the pressures of the state that the solve began from were so much larger that
/// their rounding hid the load. A spring presses less the further they are apart.
fn is_unborne(load: &Load, solved: &SolvedStep) -> bool {
    let is_apart = |found: &Evaluation| found.state == State::Separated;
    let is_pressed = matches!(load.hold, Hold::Pressure(pressure) if pressure > 0.0)
        && load.zero_stiffness == 0.0;
    is_pressed && solved.evaluation.as_ref().is_some_and(is_apart)
}

impl Attempt<'_> {
    /// Solves a load from a start.
    pub fn solve(&mut self, load: &Load, start: &Start) -> Result<Outcome, BackendError> {
        let iterations = self.setup.scene.solver.max_iterations;
        self.solve_to(self.tolerance, iterations, load, start)
    }

    fn solve_to(
        &mut self,
        tolerance: f64,
        max_iterations: usize,
        load: &Load,
        start: &Start,
    ) -> Result<Outcome, BackendError> {
        solve(
            self.solver,
            load,
            start,
            tolerance,
            max_iterations,
            self.make_backend,
            self.watch,
        )
    }

    /// Reads the solved fields and evaluates them.
    pub fn finish(&mut self, load: &Load, outcome: &Outcome) -> Result<SolvedStep, BackendError> {
        finish(self.setup, self.controller, self.solver, load, outcome)
    }

    /// Both, to a smaller tolerance where the pressures of a state within that of the scene do not add up to the load.
    pub fn solved(&mut self, load: &Load, start: &Start) -> Result<SolvedStep, BackendError> {
        let outcome = self.solve(load, start)?;
        let outcome = self.restart_stalled(load, outcome)?;
        let mut solved = self.finish(load, &outcome)?;
        if *start != Start::Cold && is_unborne(load, &solved) {
            drop(solved);
            let mut afresh = self.solve(load, &Start::Cold)?;
            afresh.iterations += outcome.iterations;
            solved = self.finish(load, &afresh)?;
        }
        let settings = &self.setup.scene.solver;
        let mut tolerance = self.tolerance;
        for _ in 0..CLOSER {
            let state = solved.evaluation.as_ref().filter(|_| solved.converged);
            if !state.is_some_and(|state| misses(self.setup, state)) {
                break;
            }
            tolerance *= CLOSER_BY;
            let before = solved.iterations;
            // Its fields are not held beside those of the solve.
            drop(solved);
            let left = settings.max_iterations.saturating_sub(before);
            let mut outcome = self.solve_to(tolerance, left, load, &Start::Present)?;
            // It need not be this close: what is still missed is warned of.
            if outcome.status != Status::PulledOff && outcome.residual <= self.tolerance {
                outcome.status = Status::Converged;
            }
            outcome.iterations += before;
            solved = self.finish(load, &outcome)?;
        }
        Ok(solved)
    }

    /// Solves on from a nearer state where a solve has stalled.
    ///
    /// All points of a direction move together, and the wall stops those that it would carry through. Where these are what the
    /// direction descends by, as in a contact of four pixels at the tip of a cone, no length of it leads on. A step of each
    /// point by itself always does.
    pub fn restart_stalled(
        &mut self,
        load: &Load,
        mut outcome: Outcome,
    ) -> Result<Outcome, BackendError> {
        let settings = &self.setup.scene.solver;
        for _ in 0..FURTHER_STARTS {
            let is_open = outcome.status == Status::Stalled && outcome.residual > self.tolerance;
            let is_held = self.problem.hardness.is_some();
            let left = settings.max_iterations.saturating_sub(outcome.iterations);
            if !is_open || is_held || !self.problem.law.has_wall() || left == 0 {
                break;
            }
            let mut nearer = self.moved_by_points(outcome.mean_pressure)?;
            if let Hold::Gap(held) = load.hold {
                // As each trial of the solver keeps it.
                let mean = self.problem.share.sum(&nearer) / self.problem.shape.len() as f64;
                let scale = if mean > 0.0 { held / mean } else { 1.0 };
                nearer.iter_mut().for_each(|gap| *gap *= scale);
            }
            let before = outcome.iterations;
            outcome = self.solve_to(self.tolerance, left, load, &Start::Gap(nearer))?;
            outcome.iterations += before;
        }
        Ok(outcome)
    }

    /// The gap after each point of the surface has moved by its own imbalance over the stiffness of the shortest wave, as far
    /// as the wall lets it.
    fn moved_by_points(&mut self, mean_pressure: f64) -> Result<LongField<f64>, BackendError> {
        let problem = self.problem;
        let stiffest = problem.stiffness_max();
        let mut gap = self.solver.gap()?;
        let elastic = self.solver.elastic_pressure()?;
        let factors = self.solver.law_factor();
        for (point, place) in problem.surface_places().enumerate() {
            let factor = factors.map_or(self.setup.law_factor(point), |factors| factors[point]);
            let traction = factor * problem.law.traction(gap[place]);
            let imbalance = imbalance(elastic[place] + mean_pressure, traction);
            gap[place] = (gap[place] - imbalance / stiffest).max(0.0);
        }
        Ok(gap)
    }
}
