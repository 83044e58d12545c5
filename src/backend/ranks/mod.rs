//! Processes that solve one contact together: each holds a slab of its rows and runs the same solver.
//!
//! Sums and scalars are the same on every rank, so all take the same decisions and meet at the same exchanges.

#[cfg(feature = "mpi")]
mod mpi;
mod threads;

#[cfg(feature = "mpi")]
pub use self::mpi::{MpiError, MpiRanks, MpiSession};
pub use threads::ThreadRanks;

use std::fmt::Debug;

/// What one of these processes exchanges with the others. Every method is called by all ranks in the same order, and
/// waits for them.
pub trait Ranks: Debug + Send + Sync {
    /// The number of this process, from 0.
    fn rank(&self) -> usize;
    /// How many processes there are.
    fn count(&self) -> usize;
    /// How many of them run on this machine.
    fn here(&self) -> usize;
    /// Sends each rank its part of `send`, and takes into `receive` what each rank sends here; the parts lie one after
    /// another in the order of the ranks, of as many bytes as the lengths say, and below 2^31 of them.
    ///
    /// # Errors
    /// Another rank has ended.
    fn exchange(&self, send: Parts<&[u8]>, receive: Parts<&mut [u8]>) -> Result<(), RankError>;
    /// Takes into `all` what every rank gives as `own`, one after another, of as many bytes as the lengths say.
    ///
    /// # Errors
    /// Another rank has ended.
    fn gather(&self, own: &[u8], all: Parts<&mut [u8]>) -> Result<(), RankError>;
}

/// Bytes that lie one after another, a part for each rank.
#[derive(Debug)]
pub struct Parts<'a, B> {
    /// All of them.
    pub bytes: B,
    /// Bytes of each part.
    pub lengths: &'a [usize],
}

/// Another process of the same contact has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("rank {rank} of this run has ended before it; its own message says why")]
pub struct RankError {
    /// Its number.
    pub rank: usize,
}

/// Takes from every rank whether what it did went well; where it did not, the first rank for which it failed keeps its
/// error, and the others have that rank's end for theirs, so that it is told once.
///
/// # Errors
/// It did not go well on one of them.
pub(crate) fn agree<T, E: From<RankError>>(ranks: &dyn Ranks, own: Result<T, E>) -> Result<T, E> {
    let mut went_well = vec![0; ranks.count()];
    let all = Parts {
        bytes: &mut went_well[..],
        lengths: &vec![1; ranks.count()],
    };
    ranks.gather(&[u8::from(own.is_ok())], all)?;
    match went_well.iter().position(|&well| well == 0) {
        None => own,
        Some(rank) if rank == ranks.rank() => own,
        Some(rank) => Err(RankError { rank }.into()),
    }
}
