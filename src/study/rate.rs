//! A step whose receding edge costs more the faster it recedes.
//!
//! The tension is raised by `1 + (v/v*)^n` on the points that held when the step began, and v is the
//! mean speed at which the edge recedes in the step. The faster it is, the more the raised tension
//! slows it, so factor and speed meet in one place, which is bracketed and found. An edge that advances
//! has the plain law, and so have points that only come to hold in the step.
//!
//! Each trial starts from the state before the step, so that the result depends on nothing else.

use super::control::Controller;
use super::edge::Edge;
use super::evaluation::PointState;
use super::setup::Setup;
use super::step::{SolvedStep, finish, solve};
use crate::backend::BackendError;
use crate::kernel::Scalars;
use crate::scene::RateScene;
use crate::solver::{ContactSolver, Load, MakeBackend, Start};

/// Relative error up to which factor and speed agree.
const AGREE: f64 = 2e-3;
/// Solves of one step at most; halving alone narrows a factor of 1000 to the agreement within 20.
const MOST_SOLVES: usize = 30;
/// How far the present end of a bracket is from a corner of it at least, as a share of it.
const CORNER: f64 = 0.05;

/// Share of its area that a contact keeps unless it lets go by itself.
const LET_GO: f64 = 0.5;

/// What a step is solved with.
pub(super) struct RatedStep<'s> {
    pub setup: &'s Setup,
    pub controller: &'s Controller<'s>,
    pub rate: RateScene,
    /// How long the step takes, s.
    pub duration: f64,
    /// Whether the solver's gap belongs to a solved step.
    pub loaded: bool,
    pub make_backend: MakeBackend<'s>,
}

impl RatedStep<'_> {
    /// Solves a load from a start.
    pub fn solve(
        &self,
        solver: &mut ContactSolver,
        load: &Load,
        start: Start,
        watch: &mut dyn FnMut(&Scalars) -> bool,
    ) -> Result<SolvedStep, BackendError> {
        let setup = self.setup;
        let problem = solver.problem();
        let before = match self.loaded {
            true => Some(problem.surface_part(&solver.gap()?)),
            false => None,
        };
        let start = match start {
            Start::Present => Start::Gap(solver.gap()?),
            other => other,
        };
        let mut iterations = 0;
        let mut trial = |factor: f64| -> Result<SolvedStep, BackendError> {
            let raised = before.as_ref().filter(|_| factor > 1.0).map(|gap| {
                let range = problem.law.range();
                let own = |point: usize| setup.law_factor(point);
                gap.iter()
                    .enumerate()
                    .map(|(point, &g)| {
                        if g < range {
                            factor * own(point)
                        } else {
                            own(point)
                        }
                    })
                    .collect()
            });
            solver.set_law_factor(raised);
            let outcome = solve(setup, solver, load, &start, self.make_backend, &mut *watch)?;
            iterations += outcome.iterations;
            let mut solved = finish(setup, self.controller, solver, load, &outcome)?;
            solved.iterations = iterations;
            Ok(solved)
        };
        let plain = trial(1.0)?;
        let Some(gap) = &before else {
            return Ok(plain);
        };
        let touched: Vec<bool> = gap.iter().map(|&g| g <= 0.0).collect();
        let edge = Edge::of(&touched, &problem.grid, problem.boundary);
        let later = |solved: &SolvedStep| {
            let touches: Vec<bool> = match &solved.evaluation {
                Some(found) => found
                    .points
                    .iter()
                    .map(|p| *p == PointState::Contact)
                    .collect(),
                None => vec![false; touched.len()],
            };
            Edge::of(&touches, &problem.grid, problem.boundary)
        };
        // By how much the factor of the speed that a trial had is above the trial's own.
        let excess = |later: &Edge, factor: f64| {
            self.rate.factor(edge.recession(later, self.duration)) - factor
        };
        let left = later(&plain);
        let first = excess(&left, 1.0);
        if !plain.converged || first <= AGREE {
            return Ok(plain);
        }
        let (mut low, mut low_excess, mut low_area) = (1.0, first, left.area);
        let (mut high, mut high_excess) = (1.0 + first, None);
        let mut factor = high;
        for solves in 1.. {
            let solved = trial(factor)?;
            let left = later(&solved);
            let found = excess(&left, factor);
            let narrow = high - low <= AGREE * high && found <= 0.0;
            if narrow && low_area < LET_GO * left.area {
                // The last equilibrium of the raised law: beyond it the contact lets go by itself.
                return trial(low);
            }
            // Where pixels let go one by one there may be no speed between; the edge waits for the next.
            if !solved.converged || found.abs() <= AGREE * factor || narrow || solves == MOST_SOLVES
            {
                return Ok(SolvedStep {
                    converged: solved.converged && solves < MOST_SOLVES,
                    ..solved
                });
            }
            if found > 0.0 {
                (low, low_excess, low_area) = (factor, found, left.area);
            } else {
                (high, high_excess) = (factor, Some(found));
            }
            let share = match high_excess {
                Some(most) => (low_excess / (low_excess - most)).clamp(CORNER, 1.0 - CORNER),
                None => 1.0,
            };
            // Every third trial halves, where the straight line gets on slowly; at the end it is the
            // upper side that is solved last.
            factor = match high - low <= AGREE * high {
                true => high,
                false if solves % 3 == 0 => 0.5 * (low + high),
                false => low + share * (high - low),
            };
        }
        Ok(plain)
    }
}
