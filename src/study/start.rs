//! The start of the solve of a step: the gap of the last one, moved to a prescribed mean gap.

use super::attempt::Attempt;
use crate::backend::BackendError;
use crate::grid::Boundary;
use crate::solver::{Hold, Load, Problem, Start};

/// Share of the mean gap below which a point moved by it is closed: the rounding of that mean in
/// double precision.
const CLOSED: f64 = 1e-13;

/// The mean over all solved points, taken about the first of the values: that of equal ones is exact on any grid.
fn mean_of(problem: &Problem, values: &[f64]) -> f64 {
    let first = problem.share.first_of(values);
    let sum = problem.share.sum_by(values, |value| value - first);
    first + sum / problem.shape.len() as f64
}

/// The last gap, moved to a new mean gap where that is prescribed; the undeformed gap at the beginning.
pub(super) fn start(attempt: &mut Attempt, load: &Load) -> Result<Start, BackendError> {
    let problem = &attempt.setup.problem;
    let controller = attempt.controller;
    // A gap of zero everywhere cannot be scaled to a mean of zero: what flows leaves it elsewhere.
    let closes = problem.hardness.is_some() && load.hold == Hold::Gap(0.0);
    if !attempt.loaded {
        let undeformed =
            || controller.undeformed_gap(attempt.value, attempt.solver.plastic_depths());
        return Ok(
            if problem.boundary == Boundary::Free || controller.is_sprung() {
                Start::Gap(undeformed().into())
            } else if closes {
                Start::Gap(problem.moved_to(undeformed(), 0.0).into())
            } else {
                Start::Cold
            },
        );
    }
    let Hold::Gap(target) = load.hold else {
        return Ok(Start::Present);
    };
    let mut gap = attempt.solver.gap()?;
    let mean = mean_of(problem, &gap);
    let least = problem.share.least_of(&gap);
    // Open surfaces move rigidly; a wall in contact stays where it is and the rest scales.
    if !problem.law.has_wall() || closes {
        gap = attempt.solver.problem().moved_to(gap, target);
    } else if least > 0.0 && least + target - mean >= 0.0 {
        let moved = target - mean;
        // Points that this move closes are set to exactly zero.
        let rounding = CLOSED.max(8.0 * attempt.solver.epsilon()) * mean.abs();
        for g in &mut gap {
            *g += moved;
            if *g <= rounding {
                *g = 0.0;
            }
        }
    } else if target <= 0.0 && problem.hardness.is_some() {
        // Pressed in beyond closure: the solid is indented everywhere.
        gap.fill(target);
    } else if mean > 0.0 {
        gap.iter_mut().for_each(|g| *g *= target / mean);
    } else {
        return Ok(Start::Cold);
    }
    Ok(Start::Gap(gap))
}
