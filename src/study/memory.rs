//! Memory that a run takes at its largest moment, counted before anything is allocated.
//!
//! The counts follow the vectors that the code makes: bytes a point of the grid, of the solved
//! points (four times as many on a free boundary) and of the tables over wavevectors. A test
//! compares them with the peak of real runs.

use super::cost::Cost;
use crate::backend::{BackendError, Shape, tally::Place};
use crate::grid::Grid;
use crate::scene::{Boundary, OutputScene, Scene, StepChoice, SurfacePart, Treatment};
use crate::solver::good_size;

/// A double on the host.
const DOUBLE: u64 = 8;
/// The program, its threads and the graphics drivers that it looks for, as measured on scenes of a
/// few points.
const PROGRAM: u64 = 72 << 20;
/// Points that the sizes of a suggested grid are multiples of.
const STRIDE: usize = 4;
/// Fields in double precision of a step that is kept: gap and pressure, and a byte for the state.
const EVALUATION: u64 = 2 * DOUBLE + 1;

/// Bytes of a run, by where they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Fields, tables and work space of the solver, on the processor or on the adapter.
    pub solver: u64,
    /// The most that this machine's own memory holds at once; with the solver where it runs on the
    /// processor.
    pub machine: u64,
    /// What the adapter holds; 0 on the processor.
    pub adapter: u64,
}

impl Memory {
    /// What a scene on `grid` takes in the place of its cost.
    pub fn of(scene: &Scene, grid: Grid, cost: &Cost) -> Memory {
        let points = grid.len() as u64;
        let shape = Shape {
            points: cost.points,
            surface: [grid.nx, grid.ny],
        };
        let solved = shape.len() as u64;
        // A periodic half-space has a formula in its place.
        let table = match (scene.grid.boundary, scene.solid.layer) {
            (Boundary::Periodic, None) => 0,
            _ => DOUBLE * shape.spectrum_len() as u64,
        };
        let solver = cost.bytes() as u64;
        let on_processor = !cost.place.on_gpu();
        let solver_here = if on_processor { solver } else { 0 };

        let building = building(scene, grid);
        // The surface keeps its heights, the problem reduced ones and the table of its stiffness.
        let kept = 2 * DOUBLE * points + table;
        // Compliance and padded heights on their way to the backend.
        let planning = table + DOUBLE * solved;
        // Gap and elastic pressure as read, padded heights, their parts on the grid, the results.
        let evaluating = 3 * DOUBLE * solved + (3 * DOUBLE + EVALUATION) * points;
        // In mixed precision the state in double, and a field on its way between it and the iterations. On
        // an adapter without double precision it is here, on others there: both are counted.
        let reference = cost.reference_bytes() as u64;
        let correcting = if reference > 0 {
            2 * DOUBLE * solved
        } else {
            0
        };
        let evaluating = evaluating + EVALUATION * points * kept_steps(scene);
        // A relaxing solid's history, what the past moves the surface by, and a problem of its own.
        let history = cost.history_bytes() as u64;
        // With adhesion a step keeps the state before it, and a search between the two three at most.
        let state = match (&scene.adhesion, &scene.capillary) {
            (None, None) => 0,
            _ => DOUBLE * solved + history,
        };
        let evaluating = evaluating + 3 * state;
        let (remembered, relaxing) = match scene.solid.relaxation.is_empty() {
            true => (history, 0),
            false => (
                history + DOUBLE * (solved + points) + table,
                // The displacement, padded heights, and a pressure of a spring as it is read.
                3 * DOUBLE * solved + EVALUATION * points,
            ),
        };
        // Pressure, residual, direction, two products and the contact, beside the results.
        let conducting = match scene.conductance {
            Some(_) => 6 * DOUBLE * solved + (DOUBLE + EVALUATION) * points,
            None => 0,
        };
        // Values of a field on their way to a file or a picture.
        let writing = (2 * EVALUATION + DOUBLE) * points;
        let solving = kept
            + remembered
            + solver_here
            + reference
            + planning
                .max(cold_start(scene, points, solver_here, table))
                .max(evaluating)
                .max(correcting)
                .max(relaxing)
                .max(conducting)
                .max(writing);
        Memory {
            solver,
            machine: PROGRAM + building.max(solving),
            adapter: if on_processor { 0 } else { solver + reference },
        }
    }

    /// The grid of the same shape, to a few points, with the most of them whose run takes at most
    /// `available` bytes of this machine's memory; `None` where not even the smallest does. Sizes
    /// are multiples of 4, which a coarse grid halves, and transform well along x.
    ///
    /// # Errors
    /// As [`Cost::of_scene`].
    pub fn largest_grid(
        scene: &Scene,
        grid: Grid,
        place: Place,
        available: u64,
    ) -> Result<Option<[usize; 2]>, BackendError> {
        let scaled = |nx: usize| -> [usize; 2] {
            let ny = nx as f64 * grid.ny as f64 / grid.nx as f64;
            let ny = (ny / STRIDE as f64).round() as usize * STRIDE;
            [nx, ny.max(STRIDE).min(grid.ny)]
        };
        let fits = |points: [usize; 2]| -> Result<bool, BackendError> {
            let grid = Grid::new(points, [grid.lx, grid.ly]);
            let cost = Cost::of_scene(scene, grid, place)?;
            Ok(Memory::of(scene, grid, &cost).machine <= available)
        };
        let sizes: Vec<usize> = (STRIDE..=grid.nx)
            .step_by(STRIDE)
            .filter(|&size| good_size(size) == size)
            .collect();
        let (mut fitting, mut beyond) = (0, sizes.len());
        while fitting < beyond {
            let middle = (fitting + beyond) / 2;
            if fits(scaled(sizes[middle]))? {
                fitting = middle + 1;
            } else {
                beyond = middle;
            }
        }
        Ok(fitting.checked_sub(1).map(|last| scaled(sizes[last])))
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
    let brackets = match &scene.adhesion {
        Some(adhesion) if adhesion.treatment == Treatment::Dmt => 2,
        _ => 0,
    };
    u64::from(keeps_last) + brackets
}

/// Bytes of a first step that is helped by coarser grids, the solver itself aside.
fn cold_start(scene: &Scene, points: u64, solver: u64, table: u64) -> u64 {
    let hard = match &scene.adhesion {
        None => true,
        Some(adhesion) => adhesion.treatment == Treatment::Dmt,
    };
    if !hard || scene.grid.boundary == Boundary::Free || scene.loading.spring.is_some() {
        return 0;
    }
    // Of each level a quarter of the one above: heights, stiffness, solver, gap; three levels.
    let levels = (2 * DOUBLE * points + 2 * table + solver) * 21 / 64;
    // The gap that comes back, and its copy on the way to the backend.
    levels + 2 * DOUBLE * points
}
