//! Ranks that are threads of one process: for tests, and to count what ranks send.

use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};

use super::{Parts, RankError, Ranks};

/// A rank that is a thread.
#[derive(Debug)]
pub struct ThreadRanks {
    rank: usize,
    to: Vec<Mutex<Sender<Vec<u8>>>>,
    from: Vec<Mutex<Receiver<Vec<u8>>>>,
    sent: AtomicUsize,
}

impl ThreadRanks {
    /// So many ranks, the first one first.
    pub fn new(count: usize) -> Vec<ThreadRanks> {
        let mut to: Vec<Vec<_>> = (0..count).map(|_| Vec::new()).collect();
        let mut from: Vec<Vec<_>> = (0..count).map(|_| Vec::new()).collect();
        for sends in &mut to {
            for receives in &mut from {
                let (sender, receiver) = channel();
                sends.push(Mutex::new(sender));
                receives.push(Mutex::new(receiver));
            }
        }
        let both = to.into_iter().zip(from).enumerate();
        both.map(|(rank, (to, from))| ThreadRanks {
            rank,
            to,
            from,
            sent: AtomicUsize::new(0),
        })
        .collect()
    }

    /// Bytes that this rank has sent to others.
    pub fn sent(&self) -> usize {
        self.sent.load(Ordering::Relaxed)
    }

    fn send(&self, rank: usize, part: &[u8]) -> Result<(), RankError> {
        if rank != self.rank {
            self.sent.fetch_add(part.len(), Ordering::Relaxed);
        }
        let to = self.to[rank].lock().unwrap_or_else(PoisonError::into_inner);
        to.send(part.to_vec()).map_err(|_| RankError { rank })
    }

    fn receive(&self, rank: usize, part: &mut [u8]) -> Result<(), RankError> {
        let from = self.from[rank]
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let bytes = from.recv().map_err(|_| RankError { rank })?;
        debug_assert_eq!(bytes.len(), part.len());
        part.copy_from_slice(&bytes);
        Ok(())
    }
}

impl Ranks for ThreadRanks {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.to.len()
    }

    fn here(&self) -> usize {
        self.count()
    }

    fn exchange(&self, send: Parts<&[u8]>, receive: Parts<&mut [u8]>) -> Result<(), RankError> {
        let mut left = send.bytes;
        for (rank, &length) in send.lengths.iter().enumerate() {
            let (part, rest) = left.split_at(length);
            self.send(rank, part)?;
            left = rest;
        }
        let mut left = receive.bytes;
        for (rank, &length) in receive.lengths.iter().enumerate() {
            let (part, rest) = left.split_at_mut(length);
            self.receive(rank, part)?;
            left = rest;
        }
        Ok(())
    }

    fn gather(&self, own: &[u8], all: Parts<&mut [u8]>) -> Result<(), RankError> {
        (0..self.count()).try_for_each(|rank| self.send(rank, own))?;
        let mut left = all.bytes;
        for (rank, &length) in all.lengths.iter().enumerate() {
            let (part, rest) = left.split_at_mut(length);
            self.receive(rank, part)?;
            left = rest;
        }
        Ok(())
    }
}
