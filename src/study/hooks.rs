//! The hooks of an effect, which the plan, the setup and the steps of a path call.
//!
//! An effect is a value of [`Hooks`]. What it carries from step to step, if anything, is a [`Carry`].
//! Nothing here knows which effects there are: `effect` lists them and passes the list in.

use std::fmt;
use std::sync::Arc;

use super::attempt::Attempt;
use super::checkpoint::{Checkpoint, CheckpointField};
use super::control::Controller;
use super::evaluation::Evaluation;
use super::observer::Unreachable;
use super::plan::Plan;
use super::row::{Column, StepRow};
use super::setup::Setup;
use super::step::SolvedStep;
use crate::backend::BackendError;
use crate::law::Law;
use crate::scene::Scene;
use crate::solver::{ContactSolver, Load, Problem, Start};

/// An effect: its description, and what it does at each place of a run. A hook that it does not implement
/// does nothing.
pub(crate) trait Hooks: Sync {
    /// Its name in summaries.
    fn name(&self) -> &'static str;
    /// What it does, in a line.
    fn purpose(&self) -> &'static str;
    /// Whether a scene asks for it.
    fn is_on(&self, scene: &Scene) -> bool;
    /// When it matters, with the number of a scene that asks for it.
    fn matters(&self, plan: &Plan) -> String;
    /// Takes it out of a scene.
    fn remove_from(&self, scene: &mut Scene);
    /// Keys and values of a scene that ask for it, as `--set` takes them, where the grid is of size 1
    /// and the contact modulus is 1.
    fn example(&self) -> &'static [(&'static str, &'static str)];

    // Before the heights are made.

    /// Warnings.
    fn warnings(&self, _plan: &Plan) -> Vec<String> {
        Vec::new()
    }
    /// The law that is solved for in place of the scene's.
    fn solved_law(&self, law: Law) -> Law {
        law
    }
    /// The problem with the effect. `map` holds the factors on the law's tension where the scene has
    /// some and the problem is no [sketch](Problem::sketch), which takes an empty vector for any field.
    fn pose(&self, problem: Problem, _scene: &Scene, _map: Option<&[f64]>) -> Problem {
        problem
    }
    /// Names of the fields that it keeps on the host from step to step, in double precision, one
    /// number a solved point each.
    fn kept_fields(&self, _scene: &Scene) -> Vec<&'static str> {
        Vec::new()
    }
    /// Further memory of the host.
    fn host_bytes(&self, _sizes: &Sizes) -> HostBytes {
        HostBytes::default()
    }

    // Along a path.

    /// Spring between a prescribed approach and the body, N/m.
    fn spring(&self, _scene: &Scene) -> Option<f64> {
        None
    }
    /// Whether it dissipates energy in every step, or follows no branch, so that jumps cannot be detected.
    fn hides_jumps(&self) -> bool {
        false
    }
    /// Whether the problem of a step depends on how long the step takes.
    fn depends_on_duration(&self) -> bool {
        false
    }
    /// The problem of steps of `duration` (s), if it is not the setup's.
    fn problem_over(&self, _setup: &Setup, _duration: f64) -> Option<Problem> {
        None
    }
    /// Why no contact can have a prescribed value.
    fn refuses(&self, _controller: &Controller, _value: f64) -> Option<Unreachable> {
        None
    }
    /// Solves a prescribed value in its own way, and not by one load.
    fn solve_value(&self, _attempt: &mut Attempt) -> Option<Result<SolvedStep, BackendError>> {
        None
    }
    /// Solves a load from a start in its own way, and not by one solve.
    fn solve_load(
        &self,
        _attempt: &mut Attempt,
        _load: &Load,
        _start: &Start,
    ) -> Option<Result<SolvedStep, BackendError>> {
        None
    }
    /// Its state from step to step, from a checkpoint or as it is at first.
    fn carry(&self, _setup: &Setup, _checkpoint: &Checkpoint) -> Option<Box<dyn Carry>> {
        None
    }
    /// Measures a converged step of the path on its solver, once; loads between two steps are not measured. If
    /// the measurement does not converge, neither has the step. `watch` sees each of its iterations with what stops them, and says
    /// whether to go on.
    fn measure(
        &self,
        _setup: &Setup,
        _solver: &mut ContactSolver,
        _solved: &mut SolvedStep,
        _watch: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(), BackendError> {
        Ok(())
    }

    /// A warning of a finished step: what is so here, and the words for any step, which are said once.
    fn warning_of_step(&self, _setup: &Setup, _row: &StepRow) -> Option<[String; 2]> {
        None
    }

    // In the tables.

    /// Its columns of `curve.csv`.
    fn columns(&self) -> &'static [Column] {
        &[]
    }
    /// Those of them that a scene asks for.
    fn columns_of(&self, _scene: &Scene) -> Vec<Column> {
        self.columns().to_vec()
    }
    /// Values of its columns that are sums over a solved state, which is `None` where the surfaces are
    /// separated.
    fn values(&self, _setup: &Setup, _evaluation: Option<&Evaluation>) -> Vec<(Column, f64)> {
        Vec::new()
    }
}

/// State of an effect from step to step of a path.
pub(crate) trait Carry: Send {
    /// A copy, to which a path can go back.
    fn copy(&self) -> Box<dyn Carry>;
    /// Its fields of a checkpoint.
    fn checkpoint_fields(&self) -> Vec<CheckpointField>;
    /// Puts a solver into the state that is carried, before any step of it.
    fn restore(&self, _solver: &mut ContactSolver) {}
    /// Prepares a solver for a step of `duration` (s).
    fn before_step(&mut self, _setup: &Setup, _solver: &mut ContactSolver, _duration: f64) {}
    /// The load to solve for in place of one that is asked for.
    fn load(&self, _solver: &ContactSolver, load: Load) -> Load {
        load
    }
    /// Takes a solved step of `duration` (s), converged or not.
    fn after_step(
        &mut self,
        _setup: &Setup,
        _solver: &mut ContactSolver,
        _solved: &mut SolvedStep,
        _duration: f64,
    ) -> Result<(), BackendError> {
        Ok(())
    }
    /// Ends a load that converged, with the surfaces loaded: makes its permanent changes.
    fn settle(&mut self, _solver: &mut ContactSolver) -> Result<(), BackendError> {
        Ok(())
    }
    /// Values of its columns.
    fn values(&self) -> Vec<(Column, f64)> {
        Vec::new()
    }
}

/// Sizes that bytes are counted by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sizes {
    /// Points of the grid.
    pub points: u64,
    /// Solved points, those of a pad included.
    pub solved: u64,
}

/// Bytes of the host's memory that effects take, their kept fields aside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HostBytes {
    /// Throughout.
    pub kept: u64,
    /// During one part of a step only; the largest counts.
    pub passing: u64,
    /// Results of solves that are held beside the one that is solved.
    pub results: u64,
}

impl HostBytes {
    /// Both together.
    fn with(self, other: HostBytes) -> HostBytes {
        HostBytes {
            kept: self.kept + other.kept,
            passing: self.passing.max(other.passing),
            results: self.results + other.results,
        }
    }
}

/// The effects that a scene asks for, in the order in which they are called.
#[derive(Clone)]
pub(crate) struct Effects(Vec<&'static dyn Hooks>);

impl Effects {
    /// Those of a list that are on in a scene.
    pub fn on(all: &[&'static dyn Hooks], scene: &Scene) -> Effects {
        Effects(
            all.iter()
                .copied()
                .filter(|effect| effect.is_on(scene))
                .collect(),
        )
    }

    /// One after the other.
    pub fn iter(&self) -> impl Iterator<Item = &'static dyn Hooks> {
        self.0.iter().copied()
    }

    /// Columns of `curve.csv` in their order.
    pub fn columns(&self, scene: &Scene) -> Vec<Column> {
        let columns = self.iter().flat_map(|effect| effect.columns_of(scene));
        let mut columns: Vec<Column> = columns.collect();
        columns.sort_by_key(|column| column.place);
        columns
    }

    /// The law that is solved for, of a scene's law.
    pub fn solved_law(&self, law: Law) -> Law {
        self.iter().fold(law, |law, effect| effect.solved_law(law))
    }

    /// A problem with all of them.
    pub fn pose(&self, problem: Problem, scene: &Scene, map: Option<&[f64]>) -> Problem {
        self.iter()
            .fold(problem, |problem, effect| effect.pose(problem, scene, map))
    }

    /// Spring between a prescribed approach and the body, N/m.
    pub fn spring(&self, scene: &Scene) -> Option<f64> {
        self.iter().find_map(|effect| effect.spring(scene))
    }

    /// Whether the problem of a step depends on how long the step takes.
    pub fn depend_on_duration(&self) -> bool {
        self.iter().any(|effect| effect.depends_on_duration())
    }

    /// The problem of steps of `duration` (s).
    pub fn problem_over(&self, setup: &Setup, duration: f64) -> Arc<Problem> {
        self.iter()
            .find_map(|effect| effect.problem_over(setup, duration))
            .map_or_else(|| Arc::clone(&setup.problem), Arc::new)
    }

    /// Whether one of them hides jumps.
    pub fn hide_jumps(&self) -> bool {
        self.iter().any(|effect| effect.hides_jumps())
    }

    /// Memory of the host beyond their kept fields.
    pub fn host_bytes(&self, sizes: &Sizes) -> HostBytes {
        self.iter().fold(HostBytes::default(), |bytes, effect| {
            bytes.with(effect.host_bytes(sizes))
        })
    }
}

impl fmt::Debug for Effects {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_list()
            .entries(self.iter().map(Hooks::name))
            .finish()
    }
}
