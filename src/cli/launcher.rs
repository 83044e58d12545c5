//! The processes that a launcher such as `mpirun` starts for one run.

use std::sync::Arc;

use super::Failure;
#[cfg(feature = "mpi")]
use crate::backend::ranks::MpiSession;
use crate::backend::ranks::Ranks;

/// What a launcher tells the processes that it starts of their number: Open MPI, and those that speak PMI.
#[cfg(not(feature = "mpi"))]
const COUNTS: [&str; 2] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE"];
/// By one of these a process knows that a launcher has started it: Open MPI, and those that speak PMI or PMIx. Without
/// one MPI is not started: it would start a service of its own.
#[cfg(feature = "mpi")]
const LAUNCHED: [&str; 4] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMI_RANK", "PMIX_RANK"];

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
        let is_launched = LAUNCHED.iter().any(|name| std::env::var_os(name).is_some());
        let session = if is_launched {
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
        let count = |name| std::env::var(name).ok()?.parse().ok();
        match COUNTS.into_iter().find_map(count) {
            Some(ranks @ 2_usize..) => Err(Failure::Launched { ranks }),
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
