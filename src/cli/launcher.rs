//! The processes that a launcher such as `mpirun` starts for one run.

use std::sync::Arc;

use super::Failure;
#[cfg(feature = "mpi")]
use crate::backend::ranks::MpiSession;
use crate::backend::ranks::Ranks;

/// What a launcher tells the processes that it starts of their number: Open MPI, and those that speak PMI.
#[cfg(any(not(feature = "mpi"), unix))]
const COUNTS: [&str; 2] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"];
/// PMIx tells a process its rank in a variable, and Slurm, which starts it by PMIx, their number.
#[cfg(any(not(feature = "mpi"), unix))]
const PMIX: [&str; 2] = ["PMIX_RANK", "SLURM_STEP_NUM_TASKS"];
/// By one of these a process knows that a launcher has started it: Open MPI, and those that speak PMI or PMIx. Without
/// one MPI is not started: it would start a service of its own.
#[cfg(feature = "mpi")]
const LAUNCHED: [&str; 4] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMI_RANK", "PMIX_RANK"];
/// What tells a process which of them it is.
#[cfg(all(feature = "mpi", unix))]
const RANKS: [&str; 3] = ["OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"];

/// The first of these variables that holds a number.
#[cfg(any(not(feature = "mpi"), unix))]
fn number_in(names: &[&str]) -> Option<usize> {
    let number = |name| std::env::var(name).ok()?.parse().ok();
    names.iter().find_map(number)
}

/// How many processes a launcher has started, if it says so.
#[cfg(any(not(feature = "mpi"), unix))]
pub(super) fn count_of_ranks() -> Option<usize> {
    let [rank, count] = PMIX;
    number_in(&COUNTS).or_else(|| number_in(&[rank]).and_then(|_| number_in(&[count])))
}

/// Whether a launcher has started this process.
#[cfg(feature = "mpi")]
pub(super) fn is_launched() -> bool {
    LAUNCHED.iter().any(|name| std::env::var_os(name).is_some())
}

/// The number of this process before MPI is started.
#[cfg(all(feature = "mpi", unix))]
pub(super) fn rank_in_launch() -> usize {
    number_in(&RANKS).unwrap_or(0)
}

/// The processes that run a scene together, until it is dropped.
pub(super) struct Launched {
    ranks: Option<Arc<dyn Ranks>>,
    // After the ranks, which it ends.
    #[cfg(feature = "mpi")]
    _session: Option<MpiSession>,
}

#[cfg(feature = "mpi")]
impl Launched {
    /// Meets the others, if a launcher has started this process.
    pub fn start() -> Result<Launched, Failure> {
        let session = if is_launched() {
            Some(MpiSession::start()?)
        } else {
            None
        };
        let ranks = session.as_ref().map(|session| {
            let ranks: Arc<dyn Ranks> = Arc::new(session.ranks());
            ranks
        });
        Ok(Launched {
            ranks: ranks.filter(|ranks| ranks.count() > 1),
            _session: session,
        })
    }
}

#[cfg(not(feature = "mpi"))]
impl Launched {
    /// Refuses a launch of several: each would solve the whole scene.
    pub fn start() -> Result<Launched, Failure> {
        match count_of_ranks() {
            Some(ranks @ 2..) => Err(Failure::Launched { ranks }),
            _ => Ok(Launched { ranks: None }),
        }
    }
}

impl Launched {
    /// The processes, if there are several.
    pub fn ranks(&self) -> Option<&Arc<dyn Ranks>> {
        self.ranks.as_ref()
    }

    /// Whether this process speaks for all: it is alone, or the first.
    pub fn speaks(&self) -> bool {
        self.ranks.as_ref().is_none_or(|ranks| ranks.rank() == 0)
    }
}
