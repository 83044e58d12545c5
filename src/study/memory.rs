//! Memory that a run takes at its largest moment, counted before anything is allocated.
//!
//! The counts follow the vectors that the code makes: bytes a point of the grid, of the solved
//! points (four times as many on a free boundary) and of the tables over wavevectors. A test
//! compares them with the peak of real runs.

use super::cost::Cost;
use crate::backend::Shape;
use crate::backend::cpu::{exchange_bytes, largest_slab};
use crate::grid::{Boundary, Grid, LONGEST_DRAWN};
use crate::scene::{Edges, FieldName, Scene, StepChoice, SurfacePart};
use crate::solver::{solved_shape, works_in_turn};
use crate::surface::points_before_resampling;

/// A double on the host.
pub(crate) const DOUBLE: u64 = 8;
/// The program and its threads, as measured on scenes of a few points.
const PROGRAM: u64 = 16 << 20;
/// MPI and its connections in a rank, as measured on the same scenes.
const MPI: u64 = 14 << 20;
/// Graphics drivers that a run looks for, as measured with a software driver on 512 x 512 points.
const DRIVERS: u64 = 56 << 20;
/// Bytes a point of the results of a step: gap and pressure, and a byte for the state.
pub(crate) const EVALUATION: u64 = 2 * DOUBLE + 1;
/// Pieces below this length stay with the allocator when they are let go (glibc on 64 bits; longer ones go back
/// to the system), and do not always fit where another is wanted: at the largest moment about half of one of the
/// solver's fields was unused. Those of a coarse start stay where the solver's own do not, but on Linux, where they come in
/// large pages and go back.
const SHORTEST_RETURNED: u64 = 32 << 20;
/// Bytes a drawn point of a picture: its value and its colour.
const DRAWN: u64 = DOUBLE + 3;
/// Bytes of the rows and columns that a rank sends at once.
const ROUND: u64 = 16 << 20;

/// Bytes of a run, by where they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    /// Fields, tables and work space of the solver, on the processor or on the adapter.
    pub solver: u64,
    /// The most that this machine's own memory holds at once; with the solver where it runs on the
    /// processor.
    pub machine: u64,
    /// The same of a path on which no step has to be searched for a jump.
    pub without_search: u64,
    /// Graphics drivers in these, where the run looks for some.
    pub drivers: u64,
    /// Bytes on the adapter; 0 on the processor.
    pub adapter: u64,
}

impl Memory {
    /// Bytes that a scene of this cost takes on `grid`.
    pub fn new(scene: &Scene, grid: Grid, cost: &Cost) -> Memory {
        Memory::on_ranks(scene, grid, cost, 1)
    }

    /// Those of the first of so many ranks that share the contact, and of each other one at most: a slab of every field.
    pub fn on_ranks(scene: &Scene, grid: Grid, cost: &Cost, ranks: usize) -> Memory {
        let rows = cost.points[1] as u128;
        let slab = largest_slab(cost.points[1], ranks) as u128;
        let own = |bytes: usize| (bytes as u128 * slab / rows.max(1)) as u64;
        let shape = Shape {
            points: cost.points,
            surface: [grid.nx, grid.ny],
        };
        let own_rows = (slab as usize).min(grid.ny);
        let points = (own_rows * grid.nx) as u64;
        let solved = own(shape.len());
        let field = DOUBLE * solved;
        let table = if cost.is_tabulated {
            own(DOUBLE as usize * shape.spectrum_len())
        } else {
            0
        };
        let solver = own(cost.bytes());
        let on_processor = !cost.place.on_gpu();
        let solver_here = if on_processor { solver } else { 0 };
        // In mixed precision the state in double. On an adapter without double precision it is here, on others there:
        // both are counted.
        let reference = own(cost.reference_bytes());
        // While it iterates, and between the iterations of one solve and those of the next.
        let idle = (solver_here + reference)
            .saturating_sub(own(cost.resting) + own(cost.reference_resting));
        let exchanged = exchange_bytes(cost.points, DOUBLE as usize, ranks) as u64;
        // Iterations and state that work in turn: the one rests while the other does.
        let in_turn = on_processor && works_in_turn(solved as usize, ranks == 1);
        let corrects = solver_here + reference - own(cost.reference_resting);
        let both = if in_turn {
            corrects.max(idle + own(cost.reference_resting))
        } else {
            solver_here + reference
        };
        let active = both + exchanged;

        // The heights, which surface and problem share, and the table of the stiffness.
        let history = own(cost.history_bytes());
        let kept = DOUBLE * points + table + history + own(cost.host.kept as usize);
        // The last result of a path of which only the last step is drawn, and those of earlier solves of a step.
        let result = EVALUATION * points;
        let results = result * (kept_steps(scene) + cost.host.results);
        // What the path goes back to where it looks between two steps, with the points in contact there.
        let state = field + history;
        let points_before = if cost.searches.jumps { points } else { 0 };
        let before = points_before + u64::from(cost.searches.keep_state()) * state;

        // A gap from which a solve starts is the host's until it ends, unless the solver has it.
        let first_start = u64::from(cost.starts_from_gap) * field;
        let start = u64::from(cost.moves_the_gap) * field;
        // A field on its way between an adapter and the state in double precision; the processor has both at hand.
        let between = if reference > 0 && !on_processor {
            field
        } else {
            0
        };
        let passing = own(cost.host.passing as usize);
        let alone = active + between.max(passing);
        let iterating = alone + start;
        // Gap and elastic pressure as read, which become the results, and the states. What is cut off a
        // larger grid is a field of its own for a moment.
        let cut = if solved > points { DOUBLE * points } else { 0 };
        let evaluating = 2 * field + cut + points;
        // Heights of a pad and the first gap on their way to the backend.
        let starting = field.max(coarse_start(cost, points, solver_here, ranks));

        // A step is solved and evaluated, then its result is written, before which the last one goes, and its gap
        // read beside the results that are kept; the checkpoint shares the history.
        let first = alone + first_start + result * cost.host.results;
        let step = iterating.max(idle + evaluating) + before + results;
        // Rows of others on their way through the first rank.
        let coming = if ranks > 1 { 2 * ROUND.min(field) } else { 0 };
        let writing = writing(scene, points, &grid) + coming;
        let ended = idle + points_before + writing.max(results + field + coming);
        let walking = first.max(step).max(ended).max(idle + starting);
        // A load between two steps is solved beside the states of both and the result of the second; its own state
        // is read beside its own result.
        let other_solver = if cost.searches.with_own_solver {
            idle + DOUBLE * points
        } else {
            0
        };
        let load = iterating.max(idle + evaluating).max(idle + result + state);
        let pull_off = u64::from(cost.searches.pull_off) * (load + before + results + other_solver);
        let jump = u64::from(cost.searches.jumps)
            * (load + before + state + results + result + other_solver);

        // Several ranks look for no adapter.
        let looks = ranks == 1 && scene.looks_for_adapters(shape.len());
        let drivers = if cfg!(feature = "gpu") && looks {
            DRIVERS
        } else {
            0
        };
        // Between the iterations and the state in double precision it is one of the longer ones.
        let number = if reference > 0 {
            DOUBLE
        } else {
            cost.place.number() as u64
        };
        let solver_field = number * solved;
        let unused = if !on_processor {
            0
        } else if solver_field < SHORTEST_RETURNED {
            solver_field / 2
        } else if cfg!(not(target_os = "linux"))
            && cost.starts_coarse
            && solver_field / 4 < SHORTEST_RETURNED
        {
            SHORTEST_RETURNED
        } else {
            0
        };
        let mpi = if ranks > 1 { MPI } else { 0 };
        let program = PROGRAM + drivers + mpi + unused;
        let building = building(scene, grid, own_rows, ranks);
        let without_search = building.max(kept + walking.max(pull_off));
        Memory {
            solver,
            machine: program + without_search.max(kept + jump),
            without_search: program + without_search,
            drivers,
            adapter: if on_processor { 0 } else { solver + reference },
        }
    }
}

/// Bytes while the heights of so many rows are made and their statistics taken. Several ranks exchange columns some at a time.
fn building(scene: &Scene, grid: Grid, rows: usize, ranks: usize) -> u64 {
    let points = (rows * grid.nx) as u64;
    let spectrum = 2 * DOUBLE * ((grid.nx / 2 + 1) * rows) as u64;
    let held_columns = |shortest: f64| -> u64 {
        let last = (grid.lx / shortest).min(grid.nx as f64 / 2.0) as u64 + 1;
        2 * DOUBLE * last * rows as u64
    };
    let whole = DOUBLE * grid.len() as u64;
    // Three buffers of an exchange: the columns, those sent and those received.
    let exchanged = match ranks {
        ..2 => 0,
        _ => 3 * ROUND.min(2 * DOUBLE * ((grid.nx / 2 + 1).div_ceil(ranks) * grid.ny) as u64),
    };
    let files = scene.surfaces.iter().filter_map(|part| match part {
        SurfacePart::File(_) => Some(DOUBLE * points),
        SurfacePart::Heights(_) => Some(whole),
        _ => None,
    });
    let map = scene
        .adhesion
        .as_ref()
        .and_then(|adhesion| adhesion.map.as_ref());
    let map = match map {
        Some(_) if ranks > 1 => DOUBLE * points,
        _ => 0,
    };
    let part = scene.surfaces.iter().map(|part| match part {
        SurfacePart::SelfAffine(rough) => {
            DOUBLE * points + held_columns(rough.shortest) + exchanged
        }
        _ => 0,
    });
    let parts = DOUBLE * points + files.sum::<u64>() + part.max().unwrap_or(0);
    let statistics = match scene.grid.boundary {
        // The spectrum by rows; its columns some at a time.
        Boundary::Periodic => DOUBLE * points + spectrum + exchanged,
        Boundary::Free => DOUBLE * points,
    };
    let files = scene.surfaces.iter().filter_map(|part| match part {
        SurfacePart::File(file) if ranks > 1 => Some(file),
        _ => None,
    });
    let before = DOUBLE * points * (files.clone().count() as u64).saturating_sub(1);
    let resampled = files.filter_map(|file| {
        let from = points_before_resampling(file)?;
        let solved = solved_shape(&Grid::new(from, [1.0; 2]), scene.grid.boundary);
        let rows = largest_slab(solved.points[1], ranks).min(from[1]);
        let old = DOUBLE * (from[0] * rows) as u64;
        let moving = 2 * ROUND.min(old);
        // What is mirrored is a quarter of it.
        let mirrored = match file.preparation.edges {
            Edges::Mirror => old + old / 4 + moving,
            _ => 0,
        };
        // Through cubics; through waves the spectrum of the old rows takes their place.
        let cubics = old + DOUBLE * points + moving;
        let waves = match scene.grid.boundary {
            Boundary::Periodic => (2 * old).max(old + spectrum + exchanged),
            Boundary::Free => 0,
        };
        Some(mirrored.max(cubics).max(waves))
    });
    let resampling = before + resampled.max().unwrap_or(0);
    let built = parts.max(resampling).max(statistics);
    built.max(DOUBLE * points + map)
}

/// Bytes of a result of so many points of a grid, and of what is written of it: values that are worked out
/// for a file or a picture, and the picture.
fn writing(scene: &Scene, points: u64, grid: &Grid) -> u64 {
    let output = &scene.output;
    // Heights are, where the solid has yielded.
    let is_made =
        |field: &&FieldName| matches!(field, FieldName::Displacement | FieldName::Heights);
    let made = output
        .fields
        .iter()
        .chain(&output.images)
        .any(|field| is_made(&field));
    let drawn = if output.images.is_empty() {
        0
    } else {
        let [width, height] = grid.drawn_size(LONGEST_DRAWN).map(u64::from);
        DRAWN * width * height
    };
    (EVALUATION + DOUBLE * u64::from(made)) * points + drawn
}

/// Results of earlier steps that are held while one is solved.
fn kept_steps(scene: &Scene) -> u64 {
    let several = scene.loading.path.len() > 1 || scene.loading.until_apart;
    let writes = !(scene.output.images.is_empty() && scene.output.fields.is_empty());
    u64::from(several && writes && scene.output.steps == StepChoice::Last)
}

/// Bytes of a first step that is helped by coarser grids, the solver itself aside.
fn coarse_start(cost: &Cost, points: u64, solver: u64, ranks: usize) -> u64 {
    if !cost.starts_coarse {
        return 0;
    }
    // One after another, the largest of a quarter of the points: its heights, also on their way to its
    // backend, a gap and a solver in single precision; and the heights of the grids below while these are
    // solved.
    let solver = solver * size_of::<f32>() as u64 / cost.place.number() as u64;
    let level = (3 * DOUBLE * points + solver) / 4 + DOUBLE * points / 12;
    // Heights and displacement of that grid, and the gap that comes back; of several ranks also the reduced heights and
    // those of the rows that the coarse grid has here.
    let between = if ranks > 1 { 2 * DOUBLE * points } else { 0 };
    level.max(DOUBLE * points * 3 / 2 + between)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    /// A grid below 512 points a side is enlarged by a whole factor, and the pixels of a narrow one are square on the surface.
    #[test]
    fn a_picture_is_counted_as_it_is_drawn() {
        let text = "grid = { points = 8, size = 1 }\nsolid = { contact_modulus = 1 }\nsurface = [{ kind = \"flat\" }]\nloading = { control = \"pressure\", path = [1] }\noutput = { images = [\"gap\"] }\n";
        let scene = Scene::parse(text, "s.toml", Path::new("."), &[]).expect("a scene");
        for (points, pixels) in [
            ([509, 509], [1018, 1018]),
            ([512, 512], [512, 512]),
            ([16384, 16], [1638, 1638]),
        ] {
            let drawn = writing(&scene, 0, &Grid::new(points, [1.0, 1.0]));
            assert_eq!(drawn, DRAWN * pixels[0] * pixels[1], "{points:?}");
        }
    }
}
