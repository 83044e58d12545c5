//! A prescribed value about to be solved, as passed to an effect that solves it in its own way.

use super::control::Controller;
use super::setup::Setup;
use super::step::{SolvedStep, finish, solve};
use crate::backend::BackendError;
use crate::kernel::Scalars;
use crate::solver::{ContactSolver, Load, MakeBackend, Outcome, Problem, Start};

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
    /// Where solvers on coarser grids get their backends from.
    pub make_backend: MakeBackend<'a>,
    /// Sees each iteration and says whether to continue.
    pub watch: &'a mut dyn FnMut(&Scalars) -> bool,
}

impl Attempt<'_> {
    /// Solves a load from a start with the scene's own settings.
    pub fn solve(&mut self, load: &Load, start: &Start) -> Result<Outcome, BackendError> {
        solve(
            self.setup,
            self.solver,
            load,
            start,
            self.make_backend,
            self.watch,
        )
    }

    /// Reads the solved fields and evaluates them.
    pub fn finish(&mut self, load: &Load, outcome: &Outcome) -> Result<SolvedStep, BackendError> {
        finish(self.setup, self.controller, self.solver, load, outcome)
    }

    /// Both.
    pub fn solved(&mut self, load: &Load, start: &Start) -> Result<SolvedStep, BackendError> {
        let outcome = self.solve(load, start)?;
        self.finish(load, &outcome)
    }
}
