//! What a solved contact conducts.
//!
//! Steady conduction across a set of spots and a further approach of the same spots, held, are one
//! harmonic problem (Barber 2003, doi:10.1098/rspa.2002.1038), whatever holds the spots together:
//! the conductance is the frozen stiffness over E*, times the harmonic mean of the conductivities.
//! Nothing flows through the gap.

use super::evaluation::{Evaluation, PointState};
use super::setup::Setup;
use crate::backend::BackendError;
use crate::solver::ContactSolver;

/// Conductance of the contact of a solved step, W/K; infinite where a periodic cell is closed
/// everywhere. `None` without `[conductance]`, or where the search for it did not converge.
pub(super) fn of(
    setup: &Setup,
    solver: &mut ContactSolver,
    evaluation: Option<&Evaluation>,
) -> Result<Option<f64>, BackendError> {
    let Some(bodies) = &setup.scene.conductance else {
        return Ok(None);
    };
    let Some(evaluation) = evaluation else {
        return Ok(Some(0.0));
    };
    let touches = |point: &PointState| f64::from(u8::from(*point == PointState::Contact));
    let contact: Vec<f64> = evaluation.points.iter().map(touches).collect();
    let settings = &setup.scene.solver;
    let stiffness =
        solver.incremental_stiffness(&contact, settings.tolerance, settings.max_iterations)?;
    let problem = solver.problem();
    // A reduced load over a reduced length is so many areas of a pixel over its side of E*.
    let side = problem.grid.pixel_area() / problem.scales.lateral;
    Ok(stiffness.map(|stiffness| bodies.combined() * stiffness * side))
}
