//! A run over several ranks. The first one leads: it keeps the folder, watches the solver and says when to end; the
//! others take the same steps and write nothing.

use std::borrow::Cow;

use crate::backend::ranks::{Parts, RankError, Ranks};
use crate::kernel::Scalars;
use crate::output::{SavedState, rows_from_text, rows_to_text};
use crate::scene::Scene;
use crate::study::{Checkpoint, Column, Earlier, FinishedStep, Observer, Search};

/// The rank that leads.
pub(super) const LEADER: usize = 0;

/// Takes from every rank whether what it did went well; where it did not, the first rank for which it failed keeps its
/// error, and the others have that rank's end for theirs, so that it is told once.
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

/// So many bytes of the leader, on every rank.
fn from_leader(ranks: &dyn Ranks, own: &[u8], length: usize) -> Result<Vec<u8>, RankError> {
    let leads = |rank: usize| rank == LEADER;
    let mut bytes = vec![0; length];
    let lengths: Vec<usize> = (0..ranks.count())
        .map(|rank| if leads(rank) { length } else { 0 })
        .collect();
    let all = Parts {
        bytes: &mut bytes[..],
        lengths: &lengths,
    };
    ranks.gather(if leads(ranks.rank()) { own } else { &[] }, all)?;
    Ok(bytes)
}

/// The same of bytes whose number only the leader knows.
fn all_from_leader(ranks: &dyn Ranks, own: &[u8]) -> Result<Vec<u8>, RankError> {
    let length = own.len() as u64;
    let length = from_leader(ranks, &length.to_le_bytes(), size_of::<u64>())?;
    let length = length.try_into().map_or(0, u64::from_le_bytes);
    from_leader(ranks, own, length as usize)
}

/// The steps that the leader's folder has already, on every rank; `own` are those that the leader found there.
///
/// # Errors
/// Another rank has ended.
pub(super) fn earlier_of_leader(
    ranks: &dyn Ranks,
    scene: &Scene,
    own: &Earlier,
) -> Result<Earlier, RankError> {
    let columns = Column::for_scene(scene);
    let rows = all_from_leader(ranks, rows_to_text(&own.rows, &columns).as_bytes())?;
    let state = SavedState {
        scene: String::new(),
        solver: serde_json::Value::Null,
        machine: String::new(),
        finished: own.rows.len(),
        curve: 0,
        warnings: Vec::new(),
        single: false,
        checkpoint: Cow::Borrowed(&own.checkpoint),
    };
    // Nothing that is written to memory fails.
    let state = all_from_leader(ranks, &state.to_bytes().unwrap_or_default())?;
    let gone = RankError { rank: LEADER };
    let rows = rows_from_text(&String::from_utf8_lossy(&rows), &columns).ok_or(gone)?;
    let state = SavedState::from_bytes(&state).ok_or(gone)?;
    Ok(Earlier {
        rows,
        checkpoint: state.checkpoint.into_owned(),
    })
}

/// The leader's observer, whose decisions the others hear.
pub(super) struct Leading<'a, O> {
    pub ranks: &'a dyn Ranks,
    pub observer: &'a mut O,
}

impl<O> Leading<'_, O> {
    /// Tells the others whether to continue; false if one of them is gone, which the next exchange of the solver tells.
    fn tell(&self, goes_on: bool) -> bool {
        from_leader(self.ranks, &[u8::from(goes_on)], 1).is_ok() && goes_on
    }
}

impl<O: Observer> Observer for Leading<'_, O> {
    type Error = O::Error;

    fn step(&mut self, step: FinishedStep) -> Result<(), O::Error> {
        let kept = self.observer.step(step);
        self.tell(kept.is_ok());
        kept
    }

    fn iteration(&mut self, step: usize, scalars: &Scalars) -> bool {
        let goes_on = self.observer.iteration(step, scalars);
        self.tell(goes_on)
    }

    fn search(&mut self, step: usize, search: Search) {
        self.observer.search(step, search);
    }

    fn wants_checkpoint(&self) -> bool {
        true
    }

    fn checkpoint(&mut self, step: usize, state: &Checkpoint) -> Result<(), O::Error> {
        let kept = self.observer.checkpoint(step, state);
        self.tell(kept.is_ok());
        kept
    }
}

/// The observer of every other rank, which does what the leader says.
pub(super) struct Following<'a> {
    pub ranks: &'a dyn Ranks,
}

impl Following<'_> {
    fn goes_on(&self) -> bool {
        from_leader(self.ranks, &[], 1).is_ok_and(|said| said == [1])
    }

    fn kept(&self) -> Result<(), RankError> {
        if self.goes_on() {
            Ok(())
        } else {
            Err(RankError { rank: LEADER })
        }
    }
}

impl Observer for Following<'_> {
    type Error = RankError;

    fn step(&mut self, _: FinishedStep) -> Result<(), RankError> {
        self.kept()
    }

    fn iteration(&mut self, _: usize, _: &Scalars) -> bool {
        self.goes_on()
    }

    // Reading a field back is an exchange, in which every rank takes part.
    fn wants_checkpoint(&self) -> bool {
        true
    }

    fn checkpoint(&mut self, _: usize, _: &Checkpoint) -> Result<(), RankError> {
        self.kept()
    }
}
