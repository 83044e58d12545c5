//! `[conductance]`: the thermal or electrical conductance of a solved contact.
//!
//! Steady conduction across a set of spots and a further approach of the same spots, held, are one
//! harmonic problem (Barber 2003, doi:10.1098/rspa.2002.1038), whatever holds the spots together:
//! the conductance is the incremental stiffness over E*, times the harmonic mean of the conductivities.
//! The gap does not conduct.

use crate::backend::BackendError;
use crate::scene::{ConductanceScene, Conduction, Scene};
use crate::solver::{ContactSolver, Problem};
use crate::study::{
    Column, DOUBLE, EVALUATION, Hooks, HostBytes, Plan, PointState, Setup, Sizes, SolvedStep,
};
use crate::units::format_si;

/// What the contact conducts; empty where the surfaces are closed everywhere or the step did not converge.
const CONDUCTANCE: Column = Column::new("conductance", "W/K", 2);
/// The same of a current.
pub(super) const ELECTRICAL: Column = Column {
    unit: "S",
    ..CONDUCTANCE
};
/// Resistance to a current; empty without contact too.
pub(super) const RESISTANCE: Column = Column::new("resistance", "ohm", 4);
/// Largest conductivity for heat, W/(m K): that of diamond and graphite is below 4000.
const HEAT: f64 = 1e4;
/// Side of a map, m, from which on a scene is in reduced units.
const REDUCED: f64 = 0.01;

/// Conduction through the area in contact.
pub(super) struct Conductance;

impl Hooks for Conductance {
    fn name(&self) -> &'static str {
        "conductance"
    }

    fn purpose(&self) -> &'static str {
        "what the area in contact conducts, in a column of its own, by conjugate gradients after each step"
    }

    fn is_on(&self, scene: &Scene) -> bool {
        scene.tables.conductance.is_some()
    }

    fn remove_from(&self, scene: &mut Scene) {
        scene.tables.conductance = None;
    }

    fn example(&self) -> &'static [(&'static str, &'static str)] {
        &[(
            "conductance",
            "{ conductivity = 1.0, counter_conductivity = 3.0 }",
        )]
    }

    fn matters(&self, plan: &Plan) -> String {
        let combined = plan.scene.tables.conductance.map_or(0.0, combined);
        let spot = combined * plan.outline.grid.pixel_area().sqrt();
        format!(
            "matters where spots are few: closed everywhere they resist no more than the bodies do; here a spot as wide as a pixel conducts {}",
            if is_electrical(&plan.scene) {
                format!(
                    "{} ({})",
                    format_si(spot, ELECTRICAL.unit),
                    format_si(1.0 / spot, RESISTANCE.unit)
                )
            } else {
                format_si(spot, CONDUCTANCE.unit)
            }
        )
    }

    fn warnings(&self, plan: &Plan) -> Vec<String> {
        let grid = plan.outline.grid;
        let is_heat = |bodies: &ConductanceScene| {
            bodies.kind == Conduction::Thermal && grid.lx.max(grid.ly) < REDUCED
        };
        let bodies = plan.scene.tables.conductance.filter(is_heat);
        let most = bodies.map(|bodies| bodies.conductivity.max(bodies.counter_conductivity));
        let slip = most.filter(|most| *most > HEAT).map(|most| {
            format!(
                "a conductivity of {most:e} W/(m K) is more than solids have for heat: was it meant in S/m?"
            )
        });
        slip.into_iter().collect()
    }

    fn pose(&self, problem: Problem, _: &Scene, _: Option<&[f64]>) -> Problem {
        problem.with_conductance()
    }

    fn host_bytes(&self, sizes: &Sizes) -> HostBytes {
        HostBytes {
            // Pressure, residual, direction, two products and the contact, beside the results.
            passing: 6 * DOUBLE * sizes.solved + (DOUBLE + EVALUATION) * sizes.points,
            ..HostBytes::default()
        }
    }

    fn columns(&self) -> &'static [Column] {
        &[CONDUCTANCE, RESISTANCE]
    }

    fn columns_of(&self, scene: &Scene) -> Vec<Column> {
        if is_electrical(scene) {
            vec![ELECTRICAL, RESISTANCE]
        } else {
            vec![CONDUCTANCE]
        }
    }

    fn measure(
        &self,
        setup: &Setup,
        solver: &mut ContactSolver,
        solved: &mut SolvedStep,
        watch: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(), BackendError> {
        let Some(bodies) = setup.scene.tables.conductance else {
            return Ok(());
        };
        let Some(evaluation) = &solved.evaluation else {
            solved.measured.push((CONDUCTANCE, 0.0));
            return Ok(());
        };
        let touches = |point: &PointState| f64::from(u8::from(*point == PointState::Contact));
        let contact: Vec<f64> = evaluation.points.iter().map(touches).collect();
        let settings = &setup.scene.solver;
        let stiffness = solver.incremental_stiffness(
            &contact,
            settings.tolerance,
            settings.max_iterations,
            watch,
        )?;
        let problem = solver.problem();
        // A reduced load over a reduced length is so many areas of a pixel over its side of E*.
        let side = problem.grid.pixel_area() / problem.scales.lateral;
        match stiffness.map(|stiffness| combined(bodies) * stiffness * side) {
            None => solved.leave_unmeasured(),
            // A periodic cell that is closed everywhere is infinitely stiff.
            Some(conductance) if conductance.is_finite() => {
                solved.measured.push((CONDUCTANCE, conductance));
                if is_electrical(&setup.scene) && conductance > 0.0 {
                    solved.measured.push((RESISTANCE, 1.0 / conductance));
                }
            }
            Some(_) => {}
        }
        Ok(())
    }
}

fn is_electrical(scene: &Scene) -> bool {
    let carrier = scene.tables.conductance.map(|bodies| bodies.kind);
    carrier == Some(Conduction::Electrical)
}

/// Harmonic mean of the two conductivities, W/(m K) or S/m: one body after the other.
fn combined(bodies: ConductanceScene) -> f64 {
    2.0 / (1.0 / bodies.conductivity + 1.0 / bodies.counter_conductivity)
}
