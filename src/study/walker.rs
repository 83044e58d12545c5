//! A solver along a path: it solves each load from the state of the last one.

use std::sync::Arc;

use super::attempt::Attempt;
use super::checkpoint::{Checkpoint, CheckpointField, GAP};
use super::control::Controller;
use super::hooks::Carry;
use super::observer::Unreachable;
use super::row::{State, StepRow};
use super::setup::Setup;
use super::start::start;
use super::step::{SolvedStep, separated, unreachable};
use crate::backend::BackendError;
use crate::backend::long_field::LongField;
use crate::kernel::Scalars;
use crate::law::Law;
use crate::scene::Control;
use crate::solver::{ContactSolver, MakeBackend, Problem};

/// The state that one load leaves for the next.
pub(super) struct Carried {
    /// Gap over all solved points, reduced; `None` where the surfaces are separated.
    gap: Option<Arc<LongField<f64>>>,
    /// Of another process: the stiffness of the zero mode under which it evaluated the pressure of that gap.
    evaluated_under: Option<f64>,
    /// States of the effects, in their order.
    effects: Vec<Box<dyn Carry>>,
}

impl Clone for Carried {
    fn clone(&self) -> Carried {
        Carried {
            gap: self.gap.clone(),
            evaluated_under: self.evaluated_under,
            effects: copies(&self.effects),
        }
    }
}

fn copies(effects: &[Box<dyn Carry>]) -> Vec<Box<dyn Carry>> {
    effects.iter().map(|carry| carry.copy()).collect()
}

impl Carried {
    /// The state of a checkpoint.
    pub fn from_checkpoint(setup: &Setup, checkpoint: &Checkpoint) -> Carried {
        let effects = setup.effects.iter();
        Carried {
            gap: checkpoint.shared(GAP),
            evaluated_under: checkpoint.evaluated_under,
            effects: effects
                .filter_map(|effect| effect.carry(setup, checkpoint))
                .collect(),
        }
    }

    /// The fields of it. The last effect's come first, as they stand in the files of versions before.
    pub fn checkpoint_fields(&self) -> Vec<CheckpointField> {
        let effects = self.effects.iter().rev();
        let mut fields: Vec<CheckpointField> = effects
            .flat_map(|carry| carry.checkpoint_fields())
            .collect();
        if let Some(gap) = &self.gap {
            fields.push(CheckpointField {
                name: GAP.to_owned(),
                values: Arc::clone(gap),
            });
        }
        fields
    }
}

/// What a path is solved with, step after step.
#[derive(Clone, Copy)]
pub(super) struct Means<'s> {
    /// The scene.
    pub setup: &'s Setup,
    /// Where solvers get their backends from.
    pub make_backend: MakeBackend<'s>,
    /// To which tolerance a load is solved.
    pub tolerance: f64,
}

/// A solver with the state of its last load, which may be kept between loads.
pub(super) struct Walker {
    pub solver: ContactSolver<'static>,
    problem: Arc<Problem>,
    /// Whether the solver's gap belongs to a solved step.
    loaded: bool,
    interrupted: bool,
    effects: Vec<Box<dyn Carry>>,
}

impl Walker {
    /// A solver of steps of `duration` (s), resumed from `carried`.
    pub fn new(means: &Means, duration: f64, carried: Carried) -> Walker {
        let problem = means.setup.effects.problem_over(means.setup, duration);
        let backend = (means.make_backend)();
        let mut walker = Walker {
            solver: ContactSolver::holding(backend, Arc::clone(&problem)),
            problem,
            loaded: false,
            interrupted: false,
            effects: Vec::new(),
        };
        walker.restore(carried);
        walker
    }

    /// Whether the surfaces are together, or a position holds them.
    pub fn is_loaded(&self) -> bool {
        self.loaded
    }

    /// Whether the watch ended the last load.
    pub fn is_interrupted(&self) -> bool {
        self.interrupted
    }

    /// Goes back to the state that a load has left.
    pub fn go_back(&mut self, carried: &Carried) {
        self.restore(carried.clone());
    }

    fn restore(&mut self, carried: Carried) {
        if let Some(gap) = &carried.gap {
            self.solver.set_gap(gap);
        }
        self.loaded = carried.gap.is_some();
        self.effects = carried.effects;
        for carry in &self.effects {
            carry.restore(&mut self.solver);
        }
        self.solver.set_evaluated_under(carried.evaluated_under);
    }

    /// Start of the next load.
    pub fn carried(&mut self) -> Result<Carried, BackendError> {
        let gap = if self.loaded {
            Some(Arc::new(self.solver.gap()?))
        } else {
            None
        };
        Ok(Carried {
            gap,
            evaluated_under: None,
            effects: copies(&self.effects),
        })
    }

    /// Solves a value of the path, `duration` (s) after the last one.
    pub fn advance(
        &mut self,
        means: &Means,
        value: f64,
        duration: f64,
        watch: &mut dyn FnMut(&Scalars) -> bool,
    ) -> Result<SolvedStep, BackendError> {
        for carry in &mut self.effects {
            carry.before_step(means.setup, &mut self.solver, duration);
        }
        let mut solved = self.solve(means, value, duration, watch)?;
        if !self.interrupted {
            for carry in &mut self.effects {
                carry.after_step(means.setup, &mut self.solver, &mut solved, duration)?;
            }
        }
        Ok(solved)
    }

    fn solve(
        &mut self,
        means: &Means,
        value: f64,
        duration: f64,
        watch: &mut dyn FnMut(&Scalars) -> bool,
    ) -> Result<SolvedStep, BackendError> {
        let Means {
            setup,
            make_backend,
            tolerance,
        } = *means;
        let problem = Arc::clone(&self.problem);
        let controller = &Controller::new(setup, &problem);
        let mut going = true;
        let mut watch = |scalars: &Scalars| {
            going = watch(scalars);
            going
        };
        let mut attempt = Attempt {
            setup,
            problem: &problem,
            controller,
            solver: &mut self.solver,
            value,
            duration,
            loaded: self.loaded,
            tolerance,
            make_backend,
            watch: &mut watch,
        };
        let mut own_ways = setup.effects.iter();
        let refusal = || {
            let mut effects = setup.effects.iter();
            effects.find_map(|effect| effect.refuses(controller, value))
        };
        let solved =
            if let Some(solved) = own_ways.find_map(|effect| effect.solve_value(&mut attempt)) {
                solved?
            } else if controller.is_load() && setup.problem.law == Law::HardWall && value <= 0.0 {
                // A wall alone carries no tension, and at zero load it only touches.
                separated()
            } else if controller.is_beyond_closure(value) {
                unreachable(Unreachable::BeyondClosure)
            } else if let Some(why) = refusal() {
                unreachable(why)
            } else {
                let load = self
                    .effects
                    .iter()
                    .fold(controller.load(value), |load, carry| {
                        carry.load(attempt.solver, load)
                    });
                let start = start(&mut attempt, &load)?;
                let mut own_ways = setup.effects.iter();
                match own_ways.find_map(|effect| effect.solve_load(&mut attempt, &load, &start)) {
                    Some(solved) => solved?,
                    None => attempt.solved(&load, &start)?,
                }
            };
        self.interrupted = !going;
        self.loaded = solved.evaluation.is_some();
        Ok(solved)
    }

    /// Has effects measure a step of the path that converged. `watch` sees each iteration of theirs, and says whether to continue.
    pub fn measure(
        &mut self,
        setup: &Setup,
        solved: &mut SolvedStep,
        watch: &mut dyn FnMut(&Scalars) -> bool,
    ) -> Result<(), BackendError> {
        let mut going = true;
        let mut watch = |iterations: usize, residual: f64| {
            going = watch(&Scalars {
                iterations: iterations as u32,
                residual,
                ..Scalars::start(0.0, false)
            });
            going
        };
        for effect in setup.effects.iter() {
            if solved.converged {
                effect.measure(setup, &mut self.solver, solved, &mut watch)?;
            }
        }
        self.interrupted = !going;
        Ok(())
    }

    /// Ends a load that converged: effects make their permanent changes.
    pub fn settle(&mut self) -> Result<(), BackendError> {
        if self.loaded {
            for carry in &mut self.effects {
                carry.settle(&mut self.solver)?;
            }
        }
        Ok(())
    }

    /// The row of a finished load.
    pub fn row(&self, setup: &Setup, step: usize, value: f64, solved: &SolvedStep) -> StepRow {
        let area = setup.surface.grid.area();
        let evaluation = solved.evaluation.as_ref();
        let no_contact = solved.unreachable.filter(|why| why.is_without_state());
        // What surfaces apart have of all that is summed over them; unknown where no contact has the prescribed value.
        let (none, apart) = match no_contact {
            Some(_) => (f64::NAN, State::Unknown),
            None => (0.0, State::Separated),
        };
        // A prescribed load is met to the residual, so the row has the prescribed one.
        let (force, mean_pressure) = match (setup.scene.loading.control, evaluation) {
            (_, None) => (none, none),
            (Control::Force, Some(_)) if solved.load_is_met => (value, value / area),
            (Control::Pressure, Some(_)) if solved.load_is_met => (value * area, value),
            (_, Some(evaluation)) => (evaluation.force, evaluation.force / area),
        };
        let mut row = StepRow {
            step,
            time: None,
            approach: evaluation.map(|e| e.position.approach),
            mean_gap: evaluation.map(|e| e.position.mean_gap),
            force,
            mean_pressure,
            contact_area_fraction: evaluation.map_or(none, |e| e.contact),
            attractive_area_fraction: evaluation.map_or(none, |e| e.attracted),
            elastic_energy: evaluation.map_or(solved.left_energy + none, |e| e.elastic_energy),
            adhesive_energy: evaluation.map_or(none, |e| e.adhesive_energy),
            iterations: solved.iterations,
            residual: solved.residual,
            converged: solved.converged,
            seconds: 0.0,
            contact_area_fraction_corrected: match evaluation {
                Some(evaluation) => evaluation.contact_corrected,
                None => setup.problem.law.has_wall().then_some(none),
            },
            state: evaluation.map_or(apart, |e| e.state),
            columns: Vec::new(),
        };
        let columns = setup.columns();
        row.columns
            .extend(columns.into_iter().map(|column| (column, None)));
        let sums = setup.effects.iter();
        let values = sums
            .flat_map(|effect| effect.values(setup, evaluation))
            .chain(self.effects.iter().flat_map(|carry| carry.values()))
            .chain(solved.measured.iter().copied());
        for (column, value) in values {
            column.set(&mut row, Some(value));
        }
        row
    }
}
