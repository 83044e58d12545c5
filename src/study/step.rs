//! One step: solved, and read back.

use super::control::Controller;
use super::evaluation::{Evaluation, Solved};
use super::setup::Setup;
use crate::backend::BackendError;
use crate::kernel::{Scalars, Status};
use crate::law::Law;
use crate::solver::{ContactSolver, Load, MakeBackend, Outcome, Start};

/// A step as solved.
pub(super) struct SolvedStep {
    /// Fields and sums; `None` where no equilibrium carries the load.
    pub evaluation: Option<Evaluation>,
    /// Whether the residual meets the tolerance.
    pub converged: bool,
    /// Iterations of all its solves.
    pub iterations: usize,
    /// The stopping measure.
    pub residual: f64,
}

/// A load that the surfaces do not carry.
pub(super) fn separated() -> SolvedStep {
    SolvedStep {
        evaluation: None,
        converged: true,
        iterations: 0,
        residual: 0.0,
    }
}

/// Solves with the scene's own settings. A sharp law is walked in careful steps first, from a state
/// that is a branch's.
pub(super) fn solve(
    setup: &Setup,
    solver: &mut ContactSolver,
    load: &Load,
    start: &Start,
    make_backend: MakeBackend,
    watch: &mut dyn FnMut(&Scalars) -> bool,
) -> Result<Outcome, BackendError> {
    let sharp = matches!(solver.problem().law, Law::MaugisDugdale(law) if law.taper == 0.0);
    let careful = sharp && *start != Start::Cold;
    let settings = &setup.scene.solver;
    solver.solve(
        load,
        start,
        settings.tolerance,
        settings.max_iterations,
        careful,
        make_backend,
        watch,
    )
}

/// Reads the solved fields and evaluates them.
pub(super) fn finish(
    setup: &Setup,
    controller: &Controller,
    solver: &mut ContactSolver,
    load: &Load,
    outcome: &Outcome,
) -> Result<SolvedStep, BackendError> {
    if outcome.status == Status::PulledOff {
        return Ok(SolvedStep {
            iterations: outcome.iterations,
            ..separated()
        });
    }
    let gap = solver.gap()?;
    let elastic = solver.elastic_pressure()?;
    let solved = Solved {
        gap: &gap,
        elastic: &elastic,
        mean_offset: solver.mean_offset(),
        flowed: solver.flowed(),
        held: outcome.mean_pressure,
        load: *load,
        law_factor: solver.law_factor(),
    };
    let problem = solver.problem();
    let evaluation = Evaluation::of(setup, problem, controller, &solved);
    // What is no number has not converged, whatever the residual makes of it.
    let is_finite = evaluation.force.is_finite() && evaluation.position.mean_gap.is_finite();
    // Nor has a state on the constant that stands in the place of a core nearer than any load takes it.
    let nearest = problem.law.least_gap() * problem.scales.length;
    let is_beyond = !problem.law.has_wall() && evaluation.gap.iter().any(|gap| *gap <= nearest);
    Ok(SolvedStep {
        evaluation: Some(evaluation),
        converged: is_finite && !is_beyond && outcome.status == Status::Converged,
        iterations: outcome.iterations,
        residual: if is_beyond {
            f64::INFINITY
        } else {
            outcome.residual
        },
    })
}
