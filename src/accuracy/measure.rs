//! Runs one setting and measures it.

use super::cells;
use super::steps::{PathVariant, StepPosition, Steps};
use crate::backend::BackendError;
use crate::clock::Clock;
use crate::kernel::Scalars;
use crate::scene::{Boundary, Control, Scene};
use crate::solver::MakeBackend;
use crate::study::{FinishedStep, Observer, Setup, StepRow, Tension, WalkEnd, WalkError, walk};

/// Compared quantities at a step of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Contact area over nominal area, with the pixel staircase taken off for laws with a wall.
    pub area: f64,
    /// The response to the path: force, N; under a load the mean gap, m, or on a free boundary the
    /// approach. `None` if the surfaces are separated and have no position.
    pub answer: Option<f64>,
}

/// Results of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// At each step of the scene; `None` for steps that are not compared.
    pub steps: Vec<Option<Point>>,
    /// Greatest tension of the path, N, positive; `None` if the path does not pass it.
    pub pull_off: Option<f64>,
    /// Additional tension, N, that was tried and not carried; 0 under a prescribed position.
    pub pull_off_step: f64,
    /// Mean pressure, Pa, over the cells of the coarsest grid at the step of greatest compression.
    pub profile: Option<Vec<f64>>,
    /// Wall-clock seconds of the steps.
    pub seconds: f64,
    /// Iterations of all steps.
    pub iterations: usize,
    /// Real two-dimensional transforms.
    pub transforms: f64,
    /// Steps solved.
    pub steps_solved: usize,
    /// Whether every step converged.
    pub converged: bool,
}

/// Why a run did not finish.
#[derive(Debug)]
pub enum Unfinished {
    /// The observer ended it.
    Stopped,
    /// The device failed.
    Backend(BackendError),
}

/// Index of the step of greatest compression.
pub fn most_compressed_step(scene: &Scene) -> usize {
    let path = &scene.loading.path;
    let closer = |a: f64, b: f64| match scene.loading.control {
        Control::MeanGap => a < b,
        _ => a > b,
    };
    (1..path.len()).fold(0, |best, step| {
        if closer(path[step], path[best]) {
            step
        } else {
            best
        }
    })
}

/// Runs the setting in `setup` along `path`; `watch` gets the step and the iteration and returns
/// whether to continue. Only steps that the path with half the steps also has are compared, so that
/// all settings are judged by the same steps.
pub fn measure(
    setup: &Setup,
    path: &PathVariant,
    scene: &Scene,
    cells: [usize; 2],
    make_backend: MakeBackend,
    watch: &mut dyn FnMut(usize, &Scalars) -> bool,
) -> Result<Measured, Unfinished> {
    let most_compressed_step = most_compressed_step(scene);
    let mut observer = Watch {
        setup,
        profiled: path.places[most_compressed_step].map(|place| place.step),
        cells,
        profile: None,
        watch,
    };
    let clock = Clock::start();
    let end = match walk(setup, make_backend, &mut observer) {
        Ok(end) => end,
        Err(WalkError::Backend(error)) => return Err(Unfinished::Backend(error)),
        Err(WalkError::Observer(never)) => match never {},
    };
    let seconds = clock.seconds();
    let profile = observer.profile;
    if end.interrupted {
        return Err(Unfinished::Stopped);
    }
    let compared = compared(scene);
    let mut steps = vec![None; scene.loading.path.len()];
    for (own, place) in path.places.iter().enumerate() {
        steps[own] = place
            .filter(|_| compared[own])
            .and_then(|place| point_at(&end.rows, place, scene));
    }
    let (pull_off, pull_off_step) = pull_off(&end, scene).unzip();
    Ok(Measured {
        steps,
        pull_off,
        pull_off_step: pull_off_step.unwrap_or(0.0),
        profile,
        seconds,
        iterations: end.rows.iter().map(|row| row.iterations).sum(),
        transforms: end.transforms,
        steps_solved: end.rows.len(),
        converged: end.rows.iter().all(|row| row.converged),
    })
}

/// Between two steps the response is taken as linear in time, as a step takes the displacement.
fn point_at(rows: &[StepRow], place: StepPosition, scene: &Scene) -> Option<Point> {
    let before = point(rows.get(place.step)?, scene);
    if place.share == 0.0 {
        return Some(before);
    }
    let after = point(rows.get(place.step + 1)?, scene);
    let between = |from: f64, to: f64| from + place.share * (to - from);
    Some(Point {
        area: between(before.area, after.area),
        answer: before
            .answer
            .zip(after.answer)
            .map(|(from, to)| between(from, to)),
    })
}

fn point(row: &StepRow, scene: &Scene) -> Point {
    let answer = match (scene.loading.control.is_load(), scene.grid.boundary) {
        (true, Boundary::Periodic) => row.mean_gap,
        (true, Boundary::Free) => row.approach,
        (false, _) => Some(row.force),
    };
    Point {
        area: row
            .contact_area_fraction_corrected
            .unwrap_or(row.contact_area_fraction),
        answer,
    }
}

/// Which steps of a scene are compared: those of the halved path.
pub fn compared(scene: &Scene) -> Vec<bool> {
    let mut compared = vec![false; scene.loading.path.len()];
    let halved = Steps::Halved.path(scene).places;
    for (compared, place) in compared.iter_mut().zip(halved) {
        *compared = place.is_some();
    }
    compared
}

/// The greatest tension, if the path passes it: a prescribed position has a step beyond it, or a
/// prescribed load has separated the contact. The second number is the additional tension that was
/// not carried.
fn pull_off(end: &WalkEnd, scene: &Scene) -> Option<(f64, f64)> {
    let tension = Tension::at_end(&scene.loading, end);
    let more = tension.bounds().map_or(0.0, |[lower, upper]| upper - lower);
    Some((tension.pull_off()?, more))
}

/// Records the pressure of one step.
struct Watch<'a> {
    setup: &'a Setup,
    /// Index of that step in the path.
    profiled: Option<usize>,
    cells: [usize; 2],
    profile: Option<Vec<f64>>,
    watch: &'a mut dyn FnMut(usize, &Scalars) -> bool,
}

impl Observer for Watch<'_> {
    type Error = std::convert::Infallible;

    fn step(&mut self, step: FinishedStep) -> Result<(), Self::Error> {
        if self.profiled == Some(step.row.step - 1) {
            let grid = &self.setup.surface.grid;
            let boundary = self.setup.scene.grid.boundary;
            self.profile = Some(match &step.evaluation {
                Some(fields) => cells::means(&fields.pressure, grid, self.cells, boundary),
                // Separated surfaces have no pressure.
                None => vec![0.0; self.cells[0] * self.cells[1]],
            });
        }
        Ok(())
    }

    fn iteration(&mut self, step: usize, scalars: &Scalars) -> bool {
        (self.watch)(step, scalars)
    }
}
