//! Memory that a run takes at its largest moment, counted before anything is allocated.
//!
//! The counts follow the vectors that the code makes: bytes a point of the grid, of the solved
//! points (four times as many on a free boundary) and of the tables over wavevectors. A test
//! compares them with the peak of real runs.

use super::cost::Cost;
use crate::backend::Shape;
use crate::grid::{Boundary, Grid};
use crate::scene::{OutputScene, Scene, StepChoice, SurfacePart};

/// A double on the host.
pub(crate) const DOUBLE: u64 = 8;
/// The program, its threads and the graphics drivers that it looks for, as measured on scenes of a
/// few points.
const PROGRAM: u64 = 72 << 20;
/// Bytes a point of the results of a step: gap and pressure, and a byte for the state.
pub(crate) const EVALUATION: u64 = 2 * DOUBLE + 1;

/// Bytes of a run, by where they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Fields, tables and work space of the solver, on the processor or on the adapter.
    pub solver: u64,
    /// The most that this machine's own memory holds at once; with the solver where it runs on the
    /// processor.
    pub machine: u64,
    /// Bytes on the adapter; 0 on the processor.
    pub adapter: u64,
}

impl Memory {
    /// Bytes that a scene of this cost takes on `grid`.
    pub fn new(scene: &Scene, grid: Grid, cost: &Cost) -> Memory {
        let points = grid.len() as u64;
        let shape = Shape {
            points: cost.points,
            surface: [grid.nx, grid.ny],
        };
        let solved = shape.len() as u64;
        let table = if cost.is_tabulated {
            DOUBLE * shape.spectrum_len() as u64
        } else {
            0
        };
        let solver = cost.bytes() as u64;
        let on_processor = !cost.place.on_gpu();
        let solver_here = if on_processor { solver } else { 0 };
        // Between the iterations of one solve and those of the next.
        let at_rest = solver_here - cost.resting as u64;

        let building = building(scene, grid);
        // The heights, which surface and problem share, and the table of the stiffness.
        let kept = DOUBLE * points + table;
        // Compliance and padded heights on their way to the backend.
        let planning = table + DOUBLE * solved;
        // Gap and elastic pressure as read, which become the results, and the states. What is cut off a
        // larger grid is a field of its own for a moment.
        let cut = if solved > points { DOUBLE * points } else { 0 };
        let evaluating = 2 * DOUBLE * solved + cut + points;
        // In mixed precision the state in double, and a field on its way between it and the iterations. On
        // an adapter without double precision it is here, on others there: both are counted.
        let reference = cost.reference_bytes() as u64;
        let correcting = if reference > 0 {
            2 * DOUBLE * solved
        } else {
            0
        };
        // Fields that effects keep from step to step, and whole states of the path. A search between two steps holds
        // the result of the second beside them while it solves.
        let history = cost.history_bytes() as u64;
        let states = cost.host.states * (DOUBLE * solved + history);
        let searched = u64::from(states > 0);
        let results = kept_steps(scene) + cost.host.results + searched;
        let held = states + EVALUATION * points * results;
        let evaluating = evaluating + held;
        let searching = searched * held;
        // A result with values of a field on their way to a file or a picture.
        let writes = !(scene.output.images.is_empty() && scene.output.fields.is_empty());
        let writing = u64::from(writes) * (EVALUATION + 2 * DOUBLE) * points;
        // A gap from which a solve starts is the host's until it ends; under a pressure on a periodic grid the solver has it.
        let start = u64::from(cost.starts_from_gap) * DOUBLE * solved;
        let iterating =
            solver_here + reference + start + searching.max(correcting).max(cost.host.passing);
        let resting = at_rest
            + (reference - cost.reference_resting as u64)
            + planning
                .max(coarse_start(cost, points, solver_here, table))
                .max(evaluating)
                .max(writing);
        let solving = kept + history + cost.host.kept + iterating.max(resting);
        Memory {
            solver,
            machine: PROGRAM + building.max(solving),
            adapter: if on_processor { 0 } else { solver + reference },
        }
    }
}

/// Bytes while the heights are made and their statistics taken.
fn building(scene: &Scene, grid: Grid) -> u64 {
    let points = grid.len() as u64;
    let spectrum = 2 * DOUBLE * ((grid.nx / 2 + 1) * grid.ny) as u64;
    let held_columns = |shortest: f64| -> u64 {
        let last = (grid.lx / shortest).min(grid.nx as f64 / 2.0) as u64 + 1;
        2 * DOUBLE * last * grid.ny as u64
    };
    let files = scene
        .surfaces
        .iter()
        .filter(|part| matches!(part, SurfacePart::File(_) | SurfacePart::Heights(_)))
        .count() as u64;
    let part = scene.surfaces.iter().map(|part| match part {
        SurfacePart::SelfAffine(rough) => DOUBLE * points + held_columns(rough.shortest),
        _ => 0,
    });
    let parts = DOUBLE * points * (1 + files) + part.max().unwrap_or(0);
    let statistics = match scene.grid.boundary {
        Boundary::Periodic => DOUBLE * points + 2 * spectrum,
        Boundary::Free => DOUBLE * points,
    };
    parts.max(statistics)
}

/// Results of earlier steps that are held while one is evaluated.
fn kept_steps(scene: &Scene) -> u64 {
    let OutputScene {
        images,
        fields,
        steps,
    } = &scene.output;
    let keeps_last = *steps == StepChoice::Last && !(images.is_empty() && fields.is_empty());
    u64::from(keeps_last)
}

/// Bytes of a first step that is helped by coarser grids, the solver itself aside.
fn coarse_start(cost: &Cost, points: u64, solver: u64, table: u64) -> u64 {
    if !cost.starts_coarse {
        return 0;
    }
    // One after another, the largest of a quarter of the points: its heights, also on their way to its
    // backend, a gap, two tables and a solver; and the heights of the grids below while these are solved.
    let level = (3 * DOUBLE * points + 2 * table + solver) / 4 + DOUBLE * points / 12;
    // Heights and displacement of that grid, and the gap that comes back.
    level.max(DOUBLE * points * 3 / 2)
}
