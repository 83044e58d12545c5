//! The cost of a scene: fields, bytes and passes, counted without running anything.

use super::control::Controller;
use super::hooks::{Effects, HostBytes, Sizes};
use super::pull_off::is_tensile;
use super::regime::law_of;
use super::setup::Setup;
use crate::backend::{
    Backend, BackendError, Level,
    dry_run::{Allocation, DryRun, Place},
};
use crate::elastic::Stiffness;
use crate::grid::Boundary;
use crate::grid::Grid;
use crate::law::Law;
use crate::scene::{BackendName, Control, Precision, Scene};
use crate::solver::{ContactSolver, Hold, Problem, Start, plan_outer_state};

/// Fields, tables and passes of a scene's solver, and what is kept between its steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Cost {
    /// Where it would run.
    pub place: Place,
    /// Fields, one number a solved point each.
    pub fields: Vec<Allocation>,
    /// Bytes that the host keeps between the steps, in double precision.
    pub history: Vec<Allocation>,
    /// Tables of factors, one a wavevector; a graphics processor has none of a periodic half-space.
    pub spectra: Vec<Allocation>,
    /// Work space of the transforms.
    pub work: Vec<Allocation>,
    /// The state in double precision beside iterations in single (mixed precision): on an adapter that has
    /// double precision, else on the processor.
    pub reference: Vec<Allocation>,
    /// Passes of one iteration, in order; `multiply` stands for the columns of a convolution.
    pub passes: Vec<&'static str>,
    /// Real two-dimensional transforms of one iteration, those of coarser levels in proportion to their points.
    pub transforms: f64,
    /// Solved points of the finest level.
    pub points: [usize; 2],
    /// Bytes of the host's memory that effects take besides the history.
    pub host: HostBytes,
    /// Bytes of the fields and of the work space that the solver lets go of between its iterations and the next solve.
    pub(super) resting: usize,
    /// The same of the state in double precision.
    pub(super) reference_resting: usize,
    /// Whether the stiffness of the waves is a table, and no formula.
    pub(super) is_tabulated: bool,
    /// Whether the first solve starts from a gap that the host holds.
    pub(super) starts_from_gap: bool,
    /// Whether the later ones do too.
    pub(super) moves_the_gap: bool,
    /// Whether the first step may be helped by coarser grids.
    pub(super) starts_coarse: bool,
    /// What is looked for between two steps of the path.
    pub(super) searches: Searches,
}

/// What is looked for between two steps of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Searches {
    /// Jumps.
    pub jumps: bool,
    /// The load of pull-off.
    pub pull_off: bool,
    /// Whether a solver of its own does it, for a problem that depends on how long a step takes.
    pub with_own_solver: bool,
}

impl Searches {
    fn new(effects: &Effects, scene: &Scene, law: Law) -> Searches {
        let loading = &scene.loading;
        let follows = law.is_adhesive() && (loading.path.len() > 1 || loading.until_apart);
        Searches {
            jumps: follows && !effects.hide_jumps(),
            pull_off: follows && is_tensile(loading),
            with_own_solver: effects.depend_on_duration(),
        }
    }

    /// Whether a step keeps the state before it.
    pub fn keep_state(self) -> bool {
        self.jumps || self.pull_off
    }
}

impl Cost {
    /// Plans a scene on a dry run: its solver and one iteration of its first load.
    ///
    /// # Errors
    /// A kernel that is given fields which it does not take: a mistake in this crate.
    pub fn for_setup(setup: &Setup) -> Result<Cost, BackendError> {
        let highest = setup.surface.highest - setup.problem.height_origin;
        let place = Place::for_scene(&setup.scene, &setup.problem.grid);
        plan(&setup.effects, &setup.problem, &setup.scene, highest, place)
    }

    /// The same from the scene, its effects and its grid alone: without heights, and without memory
    /// for any.
    pub(crate) fn with_effects(
        effects: &Effects,
        scene: &Scene,
        grid: Grid,
        place: Place,
    ) -> Result<Cost, BackendError> {
        let pixel = grid.longer_pixel();
        let law = effects.solved_law(law_of(scene, pixel, 1.0));
        let modulus = scene.solid.contact_modulus;
        let problem = Problem::sketch(grid, scene.grid.boundary, modulus, law);
        let problem = effects.pose(problem, scene, None);
        plan(effects, &problem, scene, 0.0, place)
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
    /// Where a scene runs on a grid; `auto` is the processor, since only a look at the machine says more.
    pub fn for_scene(scene: &Scene, grid: &Grid) -> Place {
        if scene.solver.backend == BackendName::Gpu {
            return match scene.arithmetic_on_gpu() {
                Precision::Double => Place::GpuDouble,
                _ => Place::Gpu,
            };
        }
        match scene.arithmetic_on_processor(grid.len()) {
            Precision::Single | Precision::Mixed => Place::Single,
            _ => Place::Double,
        }
    }

    /// Whether a state in double precision stands beside the iterations on so many points of a surface there.
    fn has_outer_state(self, scene: &Scene, points: usize) -> bool {
        let precision = match self {
            Place::Double | Place::GpuDouble => Precision::Double,
            Place::Single => scene.arithmetic_on_processor(points),
            Place::Gpu => scene.arithmetic_on_gpu(),
        };
        precision == Precision::Mixed
    }
}

fn plan(
    effects: &Effects,
    problem: &Problem,
    scene: &Scene,
    highest: f64,
    place: Place,
) -> Result<Cost, BackendError> {
    let spring = effects.spring(scene);
    let controller = Controller::with_spring(scene.loading.control, spring, highest, problem);
    let value = scene.loading.path.first().copied().unwrap_or(0.0);
    let load = controller.load(value);
    let begin = |dry_run: &mut DryRun, iterations: usize| -> Result<(), BackendError> {
        let mut solver = ContactSolver::new(dry_run, problem);
        // The counts do not depend on the tolerance.
        solver.begin(&load, &Start::Present, 0.0, false)?;
        solver.precondition_by_levels();
        (0..iterations).try_for_each(|_| solver.iterate().map(drop))?;
        solver.rest();
        Ok(())
    };
    let mut started = DryRun::on(place);
    begin(&mut started, 0)?;
    let mut iterated = DryRun::on(place);
    begin(&mut iterated, 1)?;
    if let Some(mistake) = iterated.mistake {
        return Err(mistake);
    }
    let mut reference = Vec::new();
    let mut reference_resting = 0;
    if place.has_outer_state(scene, problem.grid.len()) {
        let mut double = DryRun::on(Place::Double);
        plan_outer_state(&mut double, &mut iterated, problem, &load);
        reference_resting = double.released_bytes();
        for held in [double.fields, double.spectra, double.work] {
            reference.extend(held);
        }
    }
    let kept = effects.iter().flat_map(|effect| effect.kept_fields(scene));
    let history = kept.map(|name| Allocation {
        name,
        level: Level(0),
        bytes: problem.shape.len() * size_of::<f64>(),
    });
    let is_tabulated = matches!(problem.stiffness, Stiffness::Table(_));
    let sizes = Sizes {
        points: problem.shape.surface_len() as u64,
        solved: problem.shape.len() as u64,
    };
    let transforms = iterated.transforms() - started.transforms();
    let resting = iterated.released_bytes();
    // The scene's own law: the one that is solved for may leave the attraction out.
    let law = law_of(scene, problem.grid.longer_pixel(), 1.0);
    Ok(Cost {
        place,
        fields: iterated.fields,
        history: history.collect(),
        spectra: iterated.spectra,
        work: iterated.work,
        reference,
        transforms,
        passes: iterated.passes.split_off(started.passes.len()),
        points: problem.shape.points,
        host: effects.host_bytes(&sizes),
        resting,
        reference_resting,
        is_tabulated,
        starts_from_gap: spring.is_some()
            || problem.boundary == Boundary::Free
            || matches!(scene.loading.control, Control::MeanGap | Control::Approach),
        moves_the_gap: matches!(load.hold, Hold::Gap(_)),
        starts_coarse: started.starts_coarse()
            && problem.law == Law::HardWall
            && problem.boundary == Boundary::Periodic
            && spring.is_none(),
        searches: Searches::new(effects, scene, law),
    })
}
