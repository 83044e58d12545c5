//! One step: solved, and read back.

use super::control::Controller;
use super::evaluation::{Evaluation, Solved};
use super::observer::Unreachable;
use super::row::Column;
use super::setup::Setup;
use crate::backend::BackendError;
use crate::kernel::{Scalars, Status};
use crate::law::Law;
use crate::solver::{ContactSolver, Hold, Load, MakeBackend, Outcome, Start};

/// A step as solved.
pub(crate) struct SolvedStep {
    /// Fields and sums; `None` where no equilibrium carries the load.
    pub evaluation: Option<Evaluation>,
    /// Whether the residual meets the tolerance.
    pub converged: bool,
    /// Iterations of all its solves.
    pub iterations: usize,
    /// The stopping measure.
    pub residual: f64,
    /// Why it has not converged, if that is not for its iterations.
    pub unreachable: Option<Unreachable>,
    /// Whether the fields carry the load that was asked, where one was.
    pub load_is_met: bool,
    /// Elastic energy, J, where there are no fields: what a viscoelastic solid still stores while it recovers.
    pub left_energy: f64,
    /// Values that effects measured on the solver.
    pub measured: Vec<(Column, f64)>,
}

impl SolvedStep {
    /// Says that the contact is solved, and what is measured on it is not.
    pub fn leave_unmeasured(&mut self) {
        self.converged = false;
        self.unreachable = Some(Unreachable::Unmeasured);
    }
}

/// A load that the surfaces do not carry.
pub(crate) fn separated() -> SolvedStep {
    SolvedStep {
        evaluation: None,
        converged: true,
        iterations: 0,
        residual: 0.0,
        unreachable: None,
        load_is_met: true,
        left_energy: 0.0,
        measured: Vec::new(),
    }
}

/// A prescribed value that no contact can have.
pub(super) fn unreachable(why: Unreachable) -> SolvedStep {
    SolvedStep {
        converged: false,
        residual: f64::INFINITY,
        unreachable: Some(why),
        ..separated()
    }
}

/// Relative deviation from a prescribed mean gap that is allowed, with respect to it, to the roughness and to
/// the range: well above the rounding of sums over large grids, far below the error of a wrong position.
const MISSED: f64 = 1e-6;
/// The same in roundings of the fields, where these are larger: each of some hundred iterations adds a few.
const MISSED_ROUNDINGS: f64 = 1e4;

/// Whether a prescribed mean gap was kept.
fn keeps_gap(solver: &ContactSolver, load: &Load, gap: &[f64]) -> bool {
    let Hold::Gap(target) = load.hold else {
        return true;
    };
    let problem = solver.problem();
    let mean = problem.share.sum(gap) / problem.shape.len() as f64;
    let scale = target.abs() + problem.rms_height() + problem.law.range();
    (mean - target).abs() <= MISSED.max(MISSED_ROUNDINGS * solver.epsilon()) * scale
}

/// Share of the range of a path by which a load or a position may be missed: less than a curve shows.
const MISSED_OF_RANGE: f64 = 0.01;

/// Whether the pressures of a state miss the prescribed value by more than a curve hides.
pub(super) fn misses(setup: &Setup, evaluation: &Evaluation) -> bool {
    let values = setup.scene.loading.path.iter();
    let (least, greatest) = values.fold((0.0, 0.0), |(least, greatest): (f64, f64), value| {
        (least.min(*value), greatest.max(*value))
    });
    let range = greatest - least;
    range > 0.0 && evaluation.missed.abs() > MISSED_OF_RANGE * range
}

/// Solves to a tolerance. A sharp law begins with careful steps from the state of the last
/// solved step.
#[allow(clippy::too_many_arguments)]
pub(super) fn solve(
    solver: &mut ContactSolver,
    load: &Load,
    start: &Start,
    tolerance: f64,
    max_iterations: usize,
    make_backend: MakeBackend,
    watch: &mut dyn FnMut(&Scalars) -> bool,
) -> Result<Outcome, BackendError> {
    let sharp = matches!(solver.problem().law, Law::MaugisDugdale(law) if law.taper == 0.0);
    let careful = sharp && *start != Start::Cold;
    solver.solve(
        load,
        start,
        tolerance,
        max_iterations,
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
    solver.rest();
    let gap = solver.gap()?;
    // A balanced state at another position than the prescribed one has not converged.
    let is_there = keeps_gap(solver, load, &gap);
    let elastic = solver.elastic_pressure()?;
    let solved = Solved {
        gap,
        elastic,
        mean_offset: solver.mean_offset(),
        plastic_depth: solver.plastic_depths(),
        held: outcome.mean_pressure,
        load: *load,
        law_factor: solver.law_factor(),
    };
    let problem = solver.problem();
    let evaluation = Evaluation::new(setup, problem, controller, solved)?;
    // Non-finite fields have not converged, whatever the residual is.
    let is_finite = evaluation.force.is_finite() && evaluation.position.mean_gap.is_finite();
    // Nor has a state below the least gap, where the law is replaced by a constant.
    let nearest = problem.law.least_gap() * problem.scales.length;
    let is_beyond = !problem.law.has_wall() && problem.share.least_of(&evaluation.gap) <= nearest;
    problem.share.failed()?;
    Ok(SolvedStep {
        evaluation: Some(evaluation),
        converged: is_finite && is_there && !is_beyond && outcome.status == Status::Converged,
        iterations: outcome.iterations,
        residual: if is_beyond {
            f64::INFINITY
        } else {
            outcome.residual
        },
        unreachable: None,
        load_is_met: true,
        left_energy: 0.0,
        measured: Vec::new(),
    })
}
