//! States between two steps of a path, which have no rows: loads between those of the two steps, solved from
//! the state of the first step or of another such load.

use super::row::{State, StepRow};
use super::walker::{Carried, Means, Walker};
use crate::backend::BackendError;
use crate::kernel::Scalars;

/// The search between two steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Search {
    /// The load of pull-off, between a value of the path that held and one that did not.
    PullOff {
        /// The last that held.
        held: f64,
        /// The first that did not.
        parted: f64,
    },
    /// Whether the step passed the end of a branch of equilibria.
    Jump,
}

/// Progress of a search.
pub(super) enum Watched<'a> {
    /// An iteration of a solve.
    Iteration(&'a Scalars),
    /// How far the search is.
    Search(Search),
}

/// A place between two steps and the state there.
pub(super) struct Place {
    /// How far it lies from the one step to the other, from 0 to 1.
    pub share: f64,
    pub carried: Carried,
}

/// A load that was tried.
pub(super) struct Tried {
    pub row: StepRow,
    pub carried: Carried,
}

impl Tried {
    /// Whether the surfaces hold together.
    pub fn holds(&self) -> bool {
        self.row.approach.is_some() && self.row.state != State::Separated
    }
}

/// The interval from one step to the next.
pub(super) struct Between<'b> {
    pub means: Means<'b>,
    pub walker: &'b mut Walker,
    /// Values of the path.
    pub from: f64,
    pub to: f64,
    /// How long the step takes, s.
    pub duration: f64,
    /// Sees each iteration and says whether to continue.
    pub watch: &'b mut dyn FnMut(Watched) -> bool,
    /// Transforms of other solvers than the walker's own.
    pub transforms: f64,
    /// Whether the watch ended it.
    pub interrupted: bool,
}

impl Between<'_> {
    /// The value of the path at a place.
    pub fn value(&self, share: f64) -> f64 {
        self.from + (self.to - self.from) * share
    }

    /// Says how far the search is.
    pub fn tell(&mut self, search: Search) {
        (self.watch)(Watched::Search(search));
    }

    /// Solves the load at `share` from the state at an earlier place, in the time between the two. The
    /// walker is left with what it solved last.
    pub fn solve(&mut self, from: &Place, share: f64) -> Result<Tried, BackendError> {
        let value = self.value(share);
        let duration = (share - from.share) * self.duration;
        let means = self.means;
        let mut watch = |scalars: &Scalars| (self.watch)(Watched::Iteration(scalars));
        if !means.setup.effects.depend_on_duration() {
            self.walker.go_back(&from.carried);
            let tried = try_load(&means, self.walker, value, duration, &mut watch)?;
            self.interrupted |= self.walker.is_interrupted();
            return Ok(tried);
        }
        let mut walker = Walker::new(&means, duration, from.carried.clone());
        let tried = try_load(&means, &mut walker, value, duration, &mut watch)?;
        self.interrupted |= walker.is_interrupted();
        self.transforms += walker.solver.transforms();
        Ok(tried)
    }
}

fn try_load(
    means: &Means,
    walker: &mut Walker,
    value: f64,
    duration: f64,
    watch: &mut dyn FnMut(&Scalars) -> bool,
) -> Result<Tried, BackendError> {
    let solved = walker.advance(means, value, duration, watch)?;
    if solved.converged {
        walker.settle()?;
    }
    Ok(Tried {
        row: walker.row(means.setup, 0, value, &solved),
        carried: walker.carried()?,
    })
}
