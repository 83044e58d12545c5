//! The observer of a path, which keeps its steps and watches its solver, and the end of the path.

use std::fmt;

use super::between::Search;
use super::checkpoint::Checkpoint;
use super::evaluation::Evaluation;
use super::jumps::Jump;
use super::pull_off::PullOff;
use super::row::StepRow;
use crate::backend::BackendError;
use crate::kernel::Scalars;

/// A finished step, passed to the observer.
pub struct FinishedStep<'a> {
    /// The row of the table.
    pub row: &'a StepRow,
    /// The fields; `None` where the surfaces are separated and no field belongs to the load.
    pub evaluation: Option<Evaluation>,
    /// The jump that the step made, if it made one.
    pub jump: Option<Jump>,
    /// Whether `jump` is a guess: a load within the step that would tell did not converge.
    pub jump_is_guessed: bool,
    /// Whether no step follows.
    pub is_last: bool,
}

/// Receives the steps and watches the solver.
pub trait Observer {
    /// Why a step could not be kept.
    type Error;
    /// Keeps a finished step.
    fn step(&mut self, step: FinishedStep) -> Result<(), Self::Error>;
    /// Sees each iteration; returns whether to continue.
    fn iteration(&mut self, step: usize, scalars: &Scalars) -> bool;
    /// Is told what is looked for between a step and the one before, each time that more is known. The
    /// iterations that follow are of loads in between, which have no rows.
    fn search(&mut self, _step: usize, _search: Search) {}
    /// Whether [`checkpoint`](Observer::checkpoint) is wanted: reading fields back is not free.
    fn wants_checkpoint(&self) -> bool {
        false
    }
    /// Keeps the checkpoint after a converged step, once the step itself is kept.
    fn checkpoint(&mut self, _step: usize, _state: &Checkpoint) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// Keeps nothing but the rows, which [`walk`](super::walk) hands back, and never ends a path.
impl Observer for () {
    type Error = std::convert::Infallible;

    fn step(&mut self, _: FinishedStep) -> Result<(), Self::Error> {
        Ok(())
    }

    fn iteration(&mut self, _: usize, _: &Scalars) -> bool {
        true
    }
}

/// Why a path ended early.
#[derive(Debug, thiserror::Error)]
pub enum WalkError<E> {
    /// The device failed.
    #[error(transparent)]
    Backend(#[from] BackendError),
    /// A step could not be kept.
    #[error("a step could not be kept")]
    Observer(E),
}

/// Why a step has not converged that the iterations of its contact do not explain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Unreachable {
    /// A position beyond that at which a periodic cell is closed everywhere.
    BeyondClosure,
    /// A load beyond what a solid of its hardness bears everywhere.
    BeyondHardness,
    /// The contact is solved, and its conductance or the flow through its gap is not.
    Unmeasured,
}

impl Unreachable {
    /// Whether no contact has the prescribed value, so that there are no fields.
    pub(crate) fn is_without_state(self) -> bool {
        self != Unreachable::Unmeasured
    }
}

/// The reason as a clause.
impl fmt::Display for Unreachable {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.write_str(match self {
            Unreachable::BeyondClosure => "the surfaces cannot be closed further than full contact",
            Unreachable::BeyondHardness => "the solid flows everywhere before it bears this load",
            Unreachable::Unmeasured => "the contact is solved, and what passes through it is not",
        })
    }
}

/// How a path ended.
#[derive(Clone, Debug, Default)]
pub struct WalkEnd {
    /// Rows of all steps done.
    pub rows: Vec<StepRow>,
    /// Steps that jumped into contact.
    pub jump_in_steps: Vec<usize>,
    /// Steps that jumped off.
    pub jump_off_steps: Vec<usize>,
    /// The greatest pull-off of contacts that let go under a prescribed load; [`Tension`](super::Tension)
    /// says what the whole path shows.
    pub pull_off: Option<PullOff>,
    /// Energy that a closed loop dissipates, J.
    pub hysteresis_energy: Option<f64>,
    /// How far from it the energy may be, J, for what lies between the steps; `None` where losses depend on
    /// rates.
    pub hysteresis_uncertainty: Option<f64>,
    /// Whether the observer ended it.
    pub interrupted: bool,
    /// Why its last step has not converged, if that is not for its contact's iterations.
    pub unreachable: Option<Unreachable>,
    /// Real two-dimensional transforms.
    pub transforms: f64,
}
