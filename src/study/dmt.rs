//! The DMT force approach under a prescribed load: attraction summed over the gap of the solution
//! without it, and the repulsive load sought that leaves the asked net load.

use super::control::Controller;
use super::setup::Setup;
use super::step::{SolvedStep, finish, separated, solve};
use crate::backend::BackendError;
use crate::kernel::Scalars;
use crate::scene::Boundary;
use crate::solver::{ContactSolver, MakeBackend, Start};

/// Most hard-wall solves in one step.
const MOST_SOLVES: usize = 120;
/// Repulsive loads below this share of the law's peak are a first touch.
const TOUCH: f64 = 1e-9;

/// Width of a bracket, over the largest repulsive load, at which the net load is taken to jump.
const JUMP_WIDTH: f64 = 1e-10;

/// One repulsive load and what is left of it.
struct Balance {
    /// Repulsive mean pressure over all solved points, Pa.
    repulsive: f64,
    /// Net mean pressure less the asked one, Pa.
    excess: f64,
    solved: SolvedStep,
}

/// The largest repulsive load whose net load is `value`; separated where none is.
pub(super) fn step(
    setup: &Setup,
    controller: &Controller,
    solver: &mut ContactSolver,
    value: f64,
    loaded: bool,
    make_backend: MakeBackend,
    watch: &mut dyn FnMut(&Scalars) -> bool,
) -> Result<SolvedStep, BackendError> {
    let asked = controller.mean_pressure(value);
    let peak = setup.law.peak_tension() * setup.largest_law_factor();
    let covered = setup.surface.grid.len() as f64 / setup.problem.shape.len() as f64;
    let tolerance = setup.scene.solver.tolerance;
    let mut iterations = 0;
    let mut loaded = loaded;
    let mut balance = |repulsive: f64| -> Result<Balance, BackendError> {
        let load = controller.pressure_load(repulsive);
        let start = match (loaded, setup.problem.boundary) {
            (true, _) => Start::Present,
            (false, Boundary::Periodic) => Start::Cold,
            (false, Boundary::Free) => Start::Gap(controller.undeformed_gap(0.0, &[])),
        };
        let outcome = solve(setup, solver, &load, &start, make_backend, watch)?;
        loaded = true;
        iterations += outcome.iterations;
        let solved = finish(setup, controller, solver, &load, &outcome)?;
        let net = solved
            .evaluation
            .as_ref()
            .map_or(0.0, |evaluation| evaluation.force / controller.force(1.0));
        Ok(Balance {
            repulsive,
            excess: net - asked,
            solved,
        })
    };
    // From above: no attraction exceeds the peak everywhere, so here the net load is too large.
    // Going down by the excess never passes a balance while attraction grows with the load.
    let mut upper = balance((asked + peak * covered).max(TOUCH * peak))?;
    let scale = upper.repulsive;
    let mut lower: Option<Balance> = None;
    let mut width = f64::INFINITY;
    for _ in 0..MOST_SOLVES {
        let done = |excess: f64| excess.abs() <= tolerance * (asked.abs() + scale * 1e-3);
        // A law with tension at zero gap makes the net load jump as a point leaves the contact;
        // where the asked load lies within such a jump, the two sides of it are one state.
        let at_a_jump = width <= JUMP_WIDTH * scale;
        if !upper.solved.converged || done(upper.excess) || at_a_jump {
            upper.solved.iterations = iterations;
            return Ok(upper.solved);
        }
        let next = match &lower {
            None => upper.repulsive - upper.excess,
            Some(low) => {
                let span = upper.repulsive - low.repulsive;
                // Regula falsi where it works, halves where it does not.
                let share = upper.excess / (upper.excess - low.excess);
                let share = if span > 0.5 * width {
                    0.5
                } else {
                    share.clamp(0.05, 0.95)
                };
                width = span;
                upper.repulsive - share * span
            }
        };
        if lower.is_none() && next <= TOUCH * peak {
            return Ok(SolvedStep {
                iterations,
                ..separated()
            });
        }
        let found = balance(next)?;
        if !found.solved.converged || found.excess > 0.0 || done(found.excess) {
            upper = found;
        } else {
            lower = Some(found);
        }
    }
    upper.solved.iterations = iterations;
    upper.solved.converged = false;
    Ok(upper.solved)
}
