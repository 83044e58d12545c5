//! Ranks that an MPI launcher has started: the one place that names MPI.

use ::mpi::Count;
use ::mpi::Threading;
use ::mpi::datatype::{Partition, PartitionMut};
use ::mpi::environment::Universe;
use ::mpi::topology::SimpleCommunicator;
use ::mpi::traits::{Communicator, CommunicatorCollectives, Root};

use super::{Parts, RankError, Ranks};

/// Bytes that one message may have: MPI counts them in 32 bits with a sign.
const LARGEST: usize = Count::MAX as usize;

/// MPI in this process, from its start to its end; the end waits for all ranks.
pub struct MpiSession {
    _universe: Universe,
}

/// MPI that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "MPI cannot be used: {reason}; without mpirun, a tabor built without the feature `mpi` needs none"
)]
pub struct MpiError {
    /// The reason.
    pub reason: String,
}

impl MpiSession {
    /// Starts MPI, once in a process.
    ///
    /// # Errors
    /// It was started before, or takes no calls from other threads than the first.
    pub fn start() -> Result<MpiSession, MpiError> {
        let refused = |reason: &str| MpiError {
            reason: reason.to_owned(),
        };
        let (universe, threading) = ::mpi::initialize_with_threading(Threading::Serialized)
            .ok_or_else(|| refused("it was started before in this process"))?;
        // A solve runs on a pool of threads, and calls from one of them at a time.
        if threading < Threading::Serialized {
            return Err(refused("it takes calls from one thread alone"));
        }
        Ok(MpiSession {
            _universe: universe,
        })
    }

    /// The ranks that the launcher has started; one if there was no launcher.
    pub fn ranks(&self) -> MpiRanks {
        let world = SimpleCommunicator::world();
        MpiRanks {
            rank: world.rank() as usize,
            count: world.size() as usize,
        }
    }
}

impl Drop for MpiSession {
    fn drop(&mut self) {
        // The others wait in an exchange for one that panics, which would wait for them here.
        if std::thread::panicking() {
            SimpleCommunicator::world().abort(1);
        }
    }
}

/// The ranks of a launcher. Where one of them ends before the others, the launcher ends these.
#[derive(Debug)]
pub struct MpiRanks {
    rank: usize,
    count: usize,
}

/// Lengths as MPI counts them, and where the parts begin.
fn counted(lengths: &[usize]) -> (Vec<Count>, Vec<Count>) {
    let counts = lengths.iter().map(|&length| length as Count).collect();
    let mut start = 0;
    let starts = lengths.iter().map(|&length| {
        let here = start;
        start += length;
        here as Count
    });
    (counts, starts.collect())
}

impl Ranks for MpiRanks {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.count
    }

    fn exchange(&self, send: Parts<&[u8]>, receive: Parts<&mut [u8]>) -> Result<(), RankError> {
        debug_assert!(send.bytes.len() <= LARGEST && receive.bytes.len() <= LARGEST);
        let (counts, starts) = counted(send.lengths);
        let send = Partition::new(send.bytes, counts, starts);
        let (counts, starts) = counted(receive.lengths);
        let mut receive = PartitionMut::new(receive.bytes, counts, starts);
        SimpleCommunicator::world().all_to_all_varcount_into(&send, &mut receive);
        Ok(())
    }

    fn gather(&self, own: &[u8], all: Parts<&mut [u8]>) -> Result<(), RankError> {
        let world = SimpleCommunicator::world();
        if all.bytes.len() <= LARGEST {
            let (counts, starts) = counted(all.lengths);
            let mut all = PartitionMut::new(all.bytes, counts, starts);
            world.all_gather_varcount_into(own, &mut all);
            return Ok(());
        }
        let mut left = all.bytes;
        for (rank, &length) in all.lengths.iter().enumerate() {
            let (part, rest) = left.split_at_mut(length);
            if rank == self.rank {
                part.copy_from_slice(own);
            }
            let root = world.process_at_rank(rank as Count);
            for piece in part.chunks_mut(LARGEST) {
                root.broadcast_into(piece);
            }
            left = rest;
        }
        Ok(())
    }
}
