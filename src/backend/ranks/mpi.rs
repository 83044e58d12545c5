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
            here: world.split_shared(world.rank()).size() as usize,
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
    here: usize,
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

/// Bytes for a call of MPI. The address of an empty slice of bytes is 1, which Open MPI takes for the sign that the
/// bytes are in the other buffer.
fn sent(bytes: &[u8]) -> &[u8] {
    static NOTHING: [u8; 1] = [0];
    if bytes.is_empty() {
        &NOTHING[..0]
    } else {
        bytes
    }
}

/// The same of bytes that a call fills.
fn filled<'a>(bytes: &'a mut [u8], nothing: &'a mut [u8; 1]) -> &'a mut [u8] {
    if bytes.is_empty() {
        &mut nothing[..0]
    } else {
        bytes
    }
}

/// Where a mistake of the program would end a rank: panics if the environment asks for it. `TABOR_TEST_PANIC`, for tests, is
/// the rank and the number of exchanges before, as `2@600`.
#[cfg(feature = "fault-injection")]
fn panic_point(rank: usize) {
    use std::sync::atomic::{AtomicU64, Ordering};
    static MADE: AtomicU64 = AtomicU64::new(0);
    let made = MADE.fetch_add(1, Ordering::Relaxed);
    let asked = std::env::var("TABOR_TEST_PANIC").unwrap_or_default();
    assert!(asked != format!("{rank}@{made}"), "a test asks for this");
}

#[cfg(not(feature = "fault-injection"))]
fn panic_point(_: usize) {}

impl Ranks for MpiRanks {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.count
    }

    fn here(&self) -> usize {
        self.here
    }

    fn exchange(&self, send: Parts<&[u8]>, receive: Parts<&mut [u8]>) -> Result<(), RankError> {
        panic_point(self.rank);
        debug_assert!(send.bytes.len() <= LARGEST && receive.bytes.len() <= LARGEST);
        let mut nothing = [0];
        let (counts, starts) = counted(send.lengths);
        let send = Partition::new(sent(send.bytes), counts, starts);
        let (counts, starts) = counted(receive.lengths);
        let bytes = filled(receive.bytes, &mut nothing);
        let mut receive = PartitionMut::new(bytes, counts, starts);
        SimpleCommunicator::world().all_to_all_varcount_into(&send, &mut receive);
        Ok(())
    }

    fn gather(&self, own: &[u8], all: Parts<&mut [u8]>) -> Result<(), RankError> {
        let world = SimpleCommunicator::world();
        if all.bytes.len() <= LARGEST {
            let mut nothing = [0];
            let (counts, starts) = counted(all.lengths);
            let bytes = filled(all.bytes, &mut nothing);
            let mut all = PartitionMut::new(bytes, counts, starts);
            world.all_gather_varcount_into(sent(own), &mut all);
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
