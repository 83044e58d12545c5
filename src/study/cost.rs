//! What a scene costs: fields, bytes and passes, counted without running anything.

use super::control::Controller;
use super::setup::{Setup, resolve_law};
use crate::backend::{
    BackendError, Level,
    dry_run::{DryRun, Held, Place},
};
use crate::grid::Grid;
use crate::law::Law;
use crate::scene::{BackendName, Precision, Scene, Treatment};
use crate::solver::{ContactSolver, Problem, Start, plan_outer_state};

/// What a scene's solver holds and does, and what is kept between its steps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cost {
    /// Where it would run.
    pub place: Place,
    /// Fields, one number a solved point each.
    pub fields: Vec<Held>,
    /// What the host keeps between the steps, in double precision.
    pub history: Vec<Held>,
    /// Tables of factors, one a wavevector; a graphics processor has none of a periodic half-space.
    pub spectra: Vec<Held>,
    /// Work space of the transforms.
    pub work: Vec<Held>,
    /// The state in double precision beside iterations in single (mixed precision): on an adapter that has
    /// double precision, else on the processor.
    pub reference: Vec<Held>,
    /// Passes of one iteration, in order; `multiply` stands for the columns of a convolution.
    pub passes: Vec<&'static str>,
    /// Solved points of the finest level.
    pub points: [usize; 2],
}

impl Cost {
    /// Plans a scene on a dry run: its solver and one iteration of its first load.
    ///
    /// # Errors
    /// A kernel that is given fields which it does not take: a mistake in this crate.
    pub fn of(setup: &Setup) -> Result<Cost, BackendError> {
        let highest = setup.surface.highest - setup.problem.height_origin;
        plan(
            &setup.problem,
            &setup.scene,
            highest,
            Place::of(&setup.scene),
        )
    }

    /// The same from the scene and its grid alone: without heights, and without memory for any.
    ///
    /// # Errors
    /// As [`Cost::of`].
    pub fn of_scene(scene: &Scene, grid: Grid, place: Place) -> Result<Cost, BackendError> {
        let law = match &scene.adhesion {
            Some(adhesion) if adhesion.treatment == Treatment::Full => {
                let pixel = grid.dx().max(grid.dy());
                // Which passes there are does not depend on how strong the law is.
                resolve_law(adhesion, pixel, scene.solid.contact_modulus, 1.0)
            }
            _ => Law::HardWall,
        };
        let mapped = scene.adhesion.as_ref().is_some_and(|adhesion| {
            (adhesion.map.is_some() || adhesion.rate.is_some())
                && adhesion.treatment == Treatment::Full
        });
        let mut problem =
            Problem::sketch(grid, scene.grid.boundary, law, mapped, scene.solid.layer);
        problem.hardness = scene.solid.hardness;
        let problem = match scene.conductance {
            Some(_) => problem.conducting(),
            None => problem,
        };
        plan(&problem, scene, 0.0, place)
    }

    /// Bytes that the host keeps between the steps.
    pub fn history_bytes(&self) -> usize {
        self.history.iter().map(|held| held.bytes).sum()
    }

    /// Bytes of the state in double precision.
    pub fn reference_bytes(&self) -> usize {
        self.reference.iter().map(|held| held.bytes).sum()
    }

    /// Bytes of all that is held where the solver runs.
    pub fn bytes(&self) -> usize {
        [&self.fields, &self.spectra, &self.work]
            .into_iter()
            .flatten()
            .map(|held| held.bytes)
            .sum()
    }
}

impl Place {
    /// Where a scene runs; `auto` is the processor, since only a look at the machine says more.
    pub fn of(scene: &Scene) -> Place {
        match (scene.solver.backend, scene.arithmetic()) {
            (BackendName::Gpu, Precision::Double) => Place::GpuDouble,
            (BackendName::Gpu, _) => Place::Gpu,
            (_, Precision::Single | Precision::Mixed) => Place::Single,
            _ => Place::Double,
        }
    }
}

fn plan(
    problem: &Problem,
    scene: &Scene,
    highest: f64,
    place: Place,
) -> Result<Cost, BackendError> {
    let controller = Controller::of(&scene.loading, highest, problem);
    let value = scene.loading.path.first().copied().unwrap_or(0.0);
    let load = controller.load(value);
    let begin = |tally: &mut DryRun, iterations: usize| -> Result<(), BackendError> {
        let mut solver = ContactSolver::new(tally, problem);
        // What is counted does not depend on the tolerance.
        solver.begin(&load, &Start::Present, 0.0, false)?;
        (0..iterations).try_for_each(|_| solver.iterate().map(drop))
    };
    let mut started = DryRun::on(place);
    begin(&mut started, 0)?;
    let mut iterated = DryRun::on(place);
    begin(&mut iterated, 1)?;
    if let Some(mistake) = iterated.mistake {
        return Err(mistake);
    }
    let mut reference = Vec::new();
    if scene.arithmetic_on(place.on_gpu()) == Precision::Mixed {
        let mut double = DryRun::on(Place::Double);
        plan_outer_state(&mut double, &mut iterated, problem, &load);
        for held in [double.fields, double.spectra, double.work] {
            reference.extend(held);
        }
    }
    let branches = scene.solid.relaxation.len();
    let remembered = |name| Held {
        name,
        level: Level(0),
        bytes: problem.shape.len() * size_of::<f64>(),
    };
    // The displacement and the spring of each branch.
    let mut history = match branches {
        0 => Vec::new(),
        _ => vec![remembered("history"); branches + 1],
    };
    if scene.solid.hardness.is_some() {
        // The depths that have flowed, kept for the path and for the solver.
        history.extend([remembered("flowed"); 2]);
    }
    Ok(Cost {
        place,
        fields: iterated.fields,
        history,
        spectra: iterated.spectra,
        work: iterated.work,
        reference,
        passes: iterated.passes.split_off(started.passes.len()),
        points: problem.shape.points,
    })
}
