//! `[leakage]`: whether the gap percolates, its critical constriction, and how much fluid flows through it.
//!
//! The fluid fills what is open and presses on nothing: the contact is that of dry surfaces.

use crate::backend::{BackendError, Shape};
use crate::flow::Film;
use crate::scene::{LeakageScene, Scene};
use crate::solver::ContactSolver;
use crate::study::{Column, Hooks, HostBytes, Plan, PointState, Setup, Sizes, SolvedStep};
use crate::units::format_si;

/// Flow for each pascal between the two ends of the grid; empty where nothing holds the surfaces together.
const FLOW: Column = Column::new("flow_conductance", "m^3/(s Pa)", 6);
/// Critical constriction; 0 where the gap does not percolate.
const CONSTRICTION: Column = Column::new("critical_constriction", "m", 7);
/// Bytes a point that a run takes at its largest moment above those without leakage, as measured. It is 120 of the gap, of the
/// faces between points and the coarse graphs, and of the vectors of the iteration, while the solver's work space is not held.
const BYTES: u64 = 105;

/// Flow of a thin film through the gap.
pub(super) struct Leakage;

impl Hooks for Leakage {
    fn name(&self) -> &'static str {
        "leakage"
    }

    fn purpose(&self) -> &'static str {
        "whether the gap percolates, and how much fluid flows through it, in columns of their own, by multigrid after each step"
    }

    fn is_on(&self, scene: &Scene) -> bool {
        scene.tables.leakage.is_some()
    }

    fn remove_from(&self, scene: &mut Scene) {
        scene.tables.leakage = None;
    }

    fn example(&self) -> &'static [(&'static str, &'static str)] {
        &[("leakage", "{ viscosity = 0.1, axis = \"y\" }")]
    }

    fn matters(&self, plan: &Plan) -> String {
        let height = plan.outline.moments.rms_height();
        let viscosity = plan
            .scene
            .tables
            .leakage
            .map_or(1.0, |fluid| fluid.viscosity);
        format!(
            "matters while the gap percolates, up to a contact area of some 0.4 of the nominal one for isotropic roughness; here a square gap as wide as the rms height, {}, passes {:.2e} {}",
            format_si(height, "m"),
            height.powi(3) / (12.0 * viscosity),
            FLOW.unit
        )
    }

    fn host_bytes(&self, sizes: &Sizes) -> HostBytes {
        HostBytes {
            passing: BYTES * sizes.points,
            ..HostBytes::default()
        }
    }

    fn columns(&self) -> &'static [Column] {
        &[FLOW, CONSTRICTION]
    }

    fn measure(
        &self,
        setup: &Setup,
        _: &mut ContactSolver,
        solved: &mut SolvedStep,
        watch: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(), BackendError> {
        let (Some(LeakageScene { viscosity, axis }), Some(evaluation)) =
            (setup.scene.tables.leakage, &solved.evaluation)
        else {
            return Ok(());
        };
        // A law that repels across a gap leaves some in contact, where nothing flows.
        let open = |(gap, point): (&f64, &PointState)| {
            if *point == PointState::Contact {
                0.0
            } else {
                *gap
            }
        };
        let gap: Vec<f64> = evaluation
            .gap
            .iter()
            .zip(&evaluation.points)
            .map(open)
            .collect();
        let share = &setup.problem.share;
        let grid = setup.surface.grid;
        // The rows of the surface as equal as they can be: of a pad's rows some ranks hold no others.
        let even = share.of(Shape::whole(grid.nx, grid.ny));
        let stays = |rank: usize| share.surface_rows_of(rank) == even.rows_of(rank);
        let gap = if (0..share.count()).all(stays) {
            gap
        } else {
            let held = |rank: usize| share.surface_rows_of(rank);
            share.fetch(&gap, grid.nx, held, |rank| even.rows_of(rank).collect())?
        };
        let film = Film {
            grid,
            boundary: setup.scene.grid.boundary,
            axis,
        };
        let settings = &setup.scene.solver;
        let flow = film.flow_on(
            &even,
            gap,
            settings.tolerance,
            settings.max_iterations,
            watch,
        )?;
        if !flow.converged {
            solved.leave_unmeasured();
        }
        let conductance = flow.permeance / (12.0 * viscosity);
        solved.measured.push((FLOW, conductance));
        solved.measured.push((CONSTRICTION, flow.critical_gap));
        Ok(())
    }
}
