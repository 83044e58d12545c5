//! One solver on its way along a path: it solves a load from the state that the last one left.

use std::borrow::Cow;

use super::control::Controller;
use super::dmt;
use super::flow::{Flow, load_on};
use super::hand_over::{GAP, HandOver, HandedField};
use super::observer::Unreachable;
use super::rate::RatedStep;
use super::relaxation::{History, effective_modulus};
use super::row::{State, StepRow};
use super::setup::Setup;
use super::step::{SolvedStep, finish, separated, solve, unreachable};
use super::wear;
use crate::backend::{Backend, BackendError};
use crate::kernel::Scalars;
use crate::law::Law;
use crate::scene::{Boundary, Control};
use crate::solver::{ContactSolver, Hold, Load, MakeBackend, Problem, Start};

/// What one load leaves for the next.
#[derive(Clone, Debug)]
pub(super) struct Carried {
    /// Gap over all solved points, reduced; `None` where the surfaces are apart.
    gap: Option<Vec<f64>>,
    /// `None` for a solid that does not relax.
    history: Option<History>,
    /// `None` for a solid that cannot flow.
    flow: Option<Flow>,
}

impl Carried {
    /// What a path goes on from.
    pub fn of(setup: &Setup, hand_over: &HandOver) -> Carried {
        Carried {
            gap: hand_over.field(GAP).map(<[f64]>::to_vec),
            history: History::of(setup, hand_over),
            flow: Flow::of(setup, hand_over),
        }
    }

    /// The fields of it.
    pub fn handed_fields(&self) -> Vec<HandedField> {
        let mut fields = (self.history.as_ref()).map_or_else(Vec::new, History::handed_fields);
        fields.extend(self.flow.as_ref().and_then(Flow::handed_field));
        if let Some(gap) = &self.gap {
            fields.push(HandedField {
                name: GAP.to_owned(),
                values: gap.clone(),
            });
        }
        fields
    }
}

/// The problem that steps of `duration` (s) meet: a solid that relaxes is the stiffer the less time it has.
pub(super) fn met_problem(setup: &Setup, duration: f64) -> Cow<'_, Problem> {
    let solid = &setup.scene.solid;
    match solid.relaxation.is_empty() {
        true => Cow::Borrowed(&setup.problem),
        false => {
            let modulus = effective_modulus(solid, duration);
            Cow::Owned(setup.problem.stiffened(modulus, setup.solved_law()))
        }
    }
}

/// A solver with what its loads leave.
pub(super) struct Walker<'s> {
    pub solver: ContactSolver<'s>,
    state: PathState<'s>,
    make_backend: MakeBackend<'s>,
    history: Option<History>,
    flow: Option<Flow>,
}

impl<'s> Walker<'s> {
    /// A solver of the problem that goes on from `carried`.
    pub fn new(
        setup: &'s Setup,
        make_backend: MakeBackend<'s>,
        backend: &'s mut dyn Backend,
        problem: &'s Problem,
        carried: Carried,
    ) -> Walker<'s> {
        let mut walker = Walker {
            solver: ContactSolver::new(backend, problem),
            state: PathState {
                setup,
                controller: Controller::new(setup, problem),
                loaded: false,
                interrupted: false,
            },
            make_backend,
            history: None,
            flow: None,
        };
        walker.take(carried);
        walker
    }

    /// The scene that is walked.
    pub fn setup(&self) -> &'s Setup {
        self.state.setup
    }

    /// Where further solvers get their backends from.
    pub fn make_backend(&self) -> MakeBackend<'s> {
        self.make_backend
    }

    /// Whether the surfaces are together, or a position holds them.
    pub fn is_loaded(&self) -> bool {
        self.state.loaded
    }

    /// Whether the last load was ended by who watched it.
    pub fn is_interrupted(&self) -> bool {
        self.state.interrupted
    }

    /// Takes up the state that a load has left.
    pub fn go_back(&mut self, carried: &Carried) {
        self.take(carried.clone());
    }

    fn take(&mut self, carried: Carried) {
        if let Some(gap) = &carried.gap {
            self.solver.set_gap(gap);
        }
        self.state.loaded = carried.gap.is_some();
        self.history = carried.history;
        self.flow = carried.flow;
        if let Some(flow) = &self.flow {
            flow.lower(&mut self.solver);
        }
    }

    /// What the next load starts from.
    pub fn carried(&mut self) -> Result<Carried, BackendError> {
        Ok(Carried {
            gap: match self.state.loaded {
                true => Some(self.solver.gap()?),
                false => None,
            },
            history: self.history.clone(),
            flow: self.flow.clone(),
        })
    }

    /// Solves a value of the path, `duration` (s) after the last one.
    pub fn advance(
        &mut self,
        value: f64,
        duration: f64,
        watch: &mut dyn FnMut(&Scalars) -> bool,
    ) -> Result<SolvedStep, BackendError> {
        let solid = &self.state.setup.scene.solid;
        let offset = self.history.as_ref().map(|history| {
            let offset = history.offset(solid, duration);
            self.solver.set_offset(&offset);
            offset
        });
        let asked = Asked {
            value,
            duration,
            make_backend: self.make_backend,
        };
        let mut solved = self.state.step(&mut self.solver, &asked, watch)?;
        if let (Some(history), Some(offset), false) =
            (&mut self.history, offset, self.state.interrupted)
        {
            self.state
                .relax(&mut self.solver, &mut solved, history, offset, duration)?;
        }
        Ok(solved)
    }

    /// Ends a load that converged: what flows in it is gone for good.
    pub fn settle(&mut self) -> Result<(), BackendError> {
        match &mut self.flow {
            Some(flow) if self.state.loaded => flow.settle(&mut self.solver),
            _ => Ok(()),
        }
    }

    /// The row of a load that is settled.
    pub fn row(&self, step: usize, value: f64, solved: &SolvedStep) -> StepRow {
        let mut row = self.state.row(step, value, solved, 0.0);
        row.plastic_energy = self.flow.as_ref().map(Flow::energy);
        row
    }
}

/// Share of the mean gap below which a point moved by it is closed: the rounding of that mean in
/// double precision.
const CLOSED: f64 = 1e-13;

/// The mean, taken about the first of the values: that of equal ones is exact on any grid.
fn mean_of(values: &[f64]) -> f64 {
    let first = values[0];
    first + values.iter().map(|value| value - first).sum::<f64>() / values.len() as f64
}

/// What is asked of a step.
struct Asked<'s> {
    value: f64,
    /// How long it takes, s.
    duration: f64,
    make_backend: MakeBackend<'s>,
}

/// What one step hands to the next.
struct PathState<'s> {
    setup: &'s Setup,
    controller: Controller<'s>,
    /// Whether the solver's gap belongs to a solved step.
    loaded: bool,
    interrupted: bool,
}

impl PathState<'_> {
    fn step(
        &mut self,
        solver: &mut ContactSolver,
        asked: &Asked,
        watch: &mut dyn FnMut(&Scalars) -> bool,
    ) -> Result<SolvedStep, BackendError> {
        let setup = self.setup;
        let &Asked {
            value,
            duration,
            make_backend,
        } = asked;
        let mut going = true;
        let mut watch = |scalars: &Scalars| {
            going = watch(scalars);
            going
        };
        let is_load = self.controller.is_load();
        let solved = if setup.dmt && is_load {
            dmt::step(
                setup,
                &self.controller,
                solver,
                value,
                self.loaded,
                make_backend,
                &mut watch,
            )?
        } else if is_load && setup.problem.law == Law::HardWall && value <= 0.0 {
            // A wall alone carries no tension, and at zero load it only touches.
            separated()
        } else if self.controller.is_beyond_closure(value) {
            unreachable(Unreachable::BeyondClosure)
        } else if self.controller.is_beyond_hardness(value) {
            unreachable(Unreachable::BeyondHardness)
        } else {
            let load = load_on(solver, self.controller.load(value));
            let start = self.start(solver, &load, value)?;
            match setup.scene.adhesion.as_ref().and_then(|a| a.rate) {
                Some(rate) => {
                    let rated = RatedStep {
                        setup,
                        controller: &self.controller,
                        rate,
                        duration,
                        loaded: self.loaded,
                        make_backend,
                    };
                    rated.solve(solver, &load, start, &mut watch)?
                }
                None => {
                    let outcome = solve(setup, solver, &load, &start, make_backend, &mut watch)?;
                    finish(setup, &self.controller, solver, &load, &outcome)?
                }
            }
        };
        self.interrupted = !going;
        self.loaded = solved.evaluation.is_some();
        Ok(solved)
    }

    /// Ends a step of a solid that relaxes: its displacement goes to the history, and what its
    /// springs store to the step.
    fn relax(
        &self,
        solver: &mut ContactSolver,
        solved: &mut SolvedStep,
        history: &mut History,
        offset: Vec<f64>,
        duration: f64,
    ) -> Result<(), BackendError> {
        let solid = &self.setup.scene.solid;
        let Some(evaluation) = &mut solved.evaluation else {
            // Free of pressure it recovers: the displacement is what undoes the past.
            let displacement = offset.into_iter().map(|moved| -moved).collect();
            history.advance(solid, duration, displacement);
            return Ok(());
        };
        let problem = solver.problem();
        let rigid =
            (evaluation.displacement_offset + problem.height_origin) / problem.scales.length;
        let mut displacement = solver.gap()?;
        let heights = problem.padded(&problem.heights, 0.0);
        for (u, h) in displacement.iter_mut().zip(heights) {
            *u += h + rigid;
        }
        for (u, depth) in displacement.iter_mut().zip(solver.plastic_depths()) {
            *u -= depth;
        }
        history.advance(solid, duration, displacement);
        let mut energy = 0.0;
        let modulus = effective_modulus(solid, duration);
        energy += solid.contact_modulus / modulus * solver.energy_of(&history.displacement)?;
        for (branch, spring) in history.branches(solid) {
            energy += branch.modulus / modulus * solver.energy_of(spring)?;
        }
        let unit = problem.scales.length * problem.scales.pressure * problem.grid.pixel_area();
        evaluation.elastic_energy = energy * unit;
        Ok(())
    }

    /// The last gap, moved to a new mean gap where one is held; the undeformed gap at the beginning.
    fn start(
        &self,
        solver: &mut ContactSolver,
        load: &Load,
        value: f64,
    ) -> Result<Start, BackendError> {
        let problem = &self.setup.problem;
        if !self.loaded {
            return Ok(
                if problem.boundary == Boundary::Free || self.controller.is_sprung() {
                    Start::Gap(
                        self.controller
                            .undeformed_gap(value, solver.plastic_depths()),
                    )
                } else {
                    Start::Cold
                },
            );
        }
        let Hold::Gap(target) = load.hold else {
            return Ok(Start::Present);
        };
        let mut gap = solver.gap()?;
        let mean = mean_of(&gap);
        let least = gap.iter().copied().fold(f64::INFINITY, f64::min);
        // Open surfaces move rigidly; a wall in contact stays where it is and the rest scales.
        if !problem.law.has_wall() {
            gap = solver.problem().moved_to(gap, target);
        } else if least > 0.0 && least + target - mean >= 0.0 {
            let moved = target - mean;
            // Surfaces that meet in this very step meet everywhere they should.
            let rounding = CLOSED.max(8.0 * solver.epsilon()) * mean.abs();
            for g in &mut gap {
                *g += moved;
                if *g <= rounding {
                    *g = 0.0;
                }
            }
        } else if target <= 0.0 && problem.hardness.is_some() {
            // Pressed in beyond closure: the solid flows all over.
            gap.fill(target);
        } else if mean > 0.0 {
            gap.iter_mut().for_each(|g| *g *= target / mean);
        } else {
            return Ok(Start::Cold);
        }
        Ok(Start::Gap(gap))
    }

    fn row(&self, step: usize, value: f64, solved: &SolvedStep, seconds: f64) -> StepRow {
        let area = self.setup.surface.grid.area();
        let control = self.setup.scene.loading.control;
        let evaluation = solved.evaluation.as_ref();
        let asked = self.controller.force(self.controller.mean_pressure(value));
        // Where a load was asked the residual was met at that load, so that load it is.
        let (force, mean_pressure) = match (control, evaluation) {
            (_, None) => (0.0, 0.0),
            (_, Some(found)) if self.setup.dmt && !dmt::meets(self.setup, asked, found.force) => {
                (found.force, found.force / area)
            }
            (Control::Force, Some(_)) => (value, value / area),
            (Control::Pressure, Some(_)) => (value * area, value),
            (_, Some(evaluation)) => (evaluation.force, evaluation.force / area),
        };
        StepRow {
            step,
            time: None,
            approach: evaluation.map(|e| e.position.approach),
            mean_gap: evaluation.map(|e| e.position.mean_gap),
            force,
            mean_pressure,
            contact_area_fraction: evaluation.map_or(0.0, |e| e.contact),
            attractive_area_fraction: evaluation.map_or(0.0, |e| e.attracted),
            elastic_energy: evaluation.map_or(0.0, |e| e.elastic_energy),
            adhesive_energy: evaluation.map_or(0.0, |e| e.adhesive_energy),
            iterations: solved.iterations,
            residual: solved.residual,
            converged: solved.converged,
            seconds,
            contact_area_fraction_corrected: match evaluation {
                Some(evaluation) => evaluation.contact_corrected,
                None => self.setup.problem.law.has_wall().then_some(0.0),
            },
            state: evaluation.map_or(State::Separated, |e| e.state),
            friction_force: self.setup.scene.friction.map(|friction| {
                let touching = evaluation.map(|e| e.contact_corrected.unwrap_or(e.contact));
                friction.shear_strength * touching.unwrap_or(0.0) * area
            }),
            plastic_energy: None,
            conductance: None,
            wear_rate: self
                .setup
                .scene
                .wear
                .map(|wear| wear::rate(wear, evaluation, self.setup.surface.grid.pixel_area())),
        }
    }
}
