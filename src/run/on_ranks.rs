//! A run over several ranks. The first one leads: it keeps the folder, watches the solver and says when to end; the
//! others take the same steps, hand it their rows of what it writes, and write nothing.

use std::borrow::Cow;
use std::sync::Arc;

use super::RunError;
use crate::backend::BackendError;
use crate::backend::ranks::{Parts, RankError, Ranks, agree};
use crate::kernel::Scalars;
use crate::output::{SavedState, StateFile, hand_over, rows_from_text, rows_to_text};
use crate::scene::{FieldName, StepChoice};
use crate::study::{
    Checkpoint, CheckpointField, Column, Earlier, Evaluation, FinishedStep, Observer, PointState,
    Search, Setup,
};

/// The rank that leads.
pub(super) const LEADER: usize = 0;

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

/// What the leader asks the others for, or tells them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ask {
    /// To continue, or to end.
    GoOn(bool),
    /// Their rows of the state that they have.
    State,
    /// Their rows of a field of the step.
    Field(FieldName),
}

impl Ask {
    fn code(self) -> u8 {
        match self {
            Ask::GoOn(goes_on) => u8::from(goes_on),
            Ask::State => 2,
            Ask::Field(field) => {
                let place = FieldName::ALL.iter().position(|other| *other == field);
                3 + place.unwrap_or(0) as u8
            }
        }
    }

    fn from_code(code: u8) -> Ask {
        match code {
            0 | 1 => Ask::GoOn(code == 1),
            2 => Ask::State,
            _ => FieldName::ALL
                .get(usize::from(code) - 3)
                .map_or(Ask::GoOn(false), |field| Ask::Field(*field)),
        }
    }

    /// Tells the others; whether all are there, which the next exchange tells too.
    pub fn send(self, ranks: &dyn Ranks) -> bool {
        from_leader(ranks, &[self.code()], 1).is_ok()
    }

    /// What the leader tells; to end where it is gone.
    fn heard(ranks: &dyn Ranks) -> Ask {
        from_leader(ranks, &[], 1).map_or(Ask::GoOn(false), |code| Ask::from_code(code[0]))
    }
}

/// The steps that the leader's folder has already, on every rank, with its rows of the fields; `own` are those that the
/// leader found there, and `file` has the fields, which it reads and hands on some rows at a time.
///
/// # Errors
/// Another rank has ended; on the leader, a file that cannot be read.
pub(super) fn earlier_of_leader(
    ranks: &dyn Ranks,
    setup: &Setup,
    own: &Earlier,
    mut file: Option<StateFile>,
) -> Result<Earlier, RunError> {
    let (columns, share) = (Column::for_scene(&setup.scene), &setup.problem.share);
    let rows = all_from_leader(ranks, rows_to_text(&own.rows, &columns).as_bytes())?;
    let state = SavedState {
        scene: String::new(),
        solver: serde_json::Value::Null,
        machine: String::new(),
        finished: own.rows.len(),
        curve: 0,
        warnings: Vec::new(),
        single: false,
        checkpoint: Cow::Owned(without_values(&own.checkpoint)),
    };
    // Nothing that is written to memory fails.
    let state = all_from_leader(ranks, &state.to_bytes().unwrap_or_default())?;
    let gone = RankError { rank: LEADER };
    let rows = rows_from_text(&String::from_utf8_lossy(&rows), &columns).ok_or(gone)?;
    let state = SavedState::from_bytes(&state).ok_or(gone)?;
    let mut checkpoint = state.checkpoint.into_owned();
    // To the end, whatever becomes of what is read: the other ranks take all.
    let mut read = Ok(());
    for field in &mut checkpoint.fields {
        let rows = share.from_first(false, &mut |values| {
            if let (Ok(()), Some(file)) = (&read, &mut file) {
                read = file.numbers(values);
            }
        });
        field.values = Arc::new(rows?.into());
    }
    if let Some(points) = &mut checkpoint.points {
        let rows = share.from_first(true, &mut |states| {
            if let (Ok(()), Some(file)) = (&read, &mut file) {
                read = file.states(states);
            }
        })?;
        points.extend(rows.into_iter().filter_map(PointState::from_byte));
    }
    agree(ranks, read.map_err(RunError::from))?;
    Ok(Earlier { rows, checkpoint })
}

/// A checkpoint whose fields are empty.
fn without_values(checkpoint: &Checkpoint) -> Checkpoint {
    let fields = checkpoint.fields.iter().map(|field| CheckpointField {
        name: field.name.clone(),
        values: Arc::default(),
    });
    Checkpoint {
        fields: fields.collect(),
        points: checkpoint.points.as_ref().map(|_| Vec::new()),
        evaluated_under: checkpoint.evaluated_under,
        jump_in_steps: checkpoint.jump_in_steps.clone(),
        jump_off_steps: checkpoint.jump_off_steps.clone(),
        pull_off: checkpoint.pull_off,
        transforms: checkpoint.transforms,
    }
}

/// The leader's observer, whose decisions the others hear.
pub(super) struct Leading<'a, O> {
    pub ranks: &'a dyn Ranks,
    pub observer: &'a mut O,
}

impl<O> Leading<'_, O> {
    /// Tells the others whether to continue; false if one of them is gone, which the next exchange of the solver tells.
    fn tell(&self, goes_on: bool) -> bool {
        Ask::GoOn(goes_on).send(self.ranks) && goes_on
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
    ranks: &'a dyn Ranks,
    setup: &'a Setup,
    /// The fields of the step of which the leader may ask for some.
    evaluation: Option<Evaluation>,
}

impl<'a> Following<'a> {
    /// Follows the leader of these ranks.
    pub fn new(ranks: &'a dyn Ranks, setup: &'a Setup) -> Self {
        Following {
            ranks,
            setup,
            evaluation: None,
        }
    }

    /// Whether the leader may ask for fields of a step after those that follow it.
    fn keeps_fields(&self) -> bool {
        let output = &self.setup.scene.output;
        let asked = !(output.images.is_empty() && output.fields.is_empty());
        asked && output.steps == StepChoice::Last
    }

    /// Hands over what the leader asks for until it says whether to continue.
    fn heed(&self, state: &Checkpoint) -> Result<bool, BackendError> {
        let share = &self.setup.problem.share;
        loop {
            match Ask::heard(self.ranks) {
                Ask::GoOn(goes_on) => return Ok(goes_on),
                Ask::State => hand_over(state, Some(share), &mut |_| {})?,
                Ask::Field(field) => {
                    let heights = &self.setup.surface.heights;
                    let evaluation = self.evaluation.as_ref();
                    let values = evaluation.map(|found| found.field(field, heights));
                    let values = values.as_deref().unwrap_or(&[]);
                    share.to_first(values, share.surface()[0], &mut |_| {})?;
                }
            }
        }
    }

    /// The same where the leader's end is this one's too.
    pub fn kept(&self, state: &Checkpoint) -> Result<(), RankError> {
        match self.heed(state) {
            Ok(true) => Ok(()),
            _ => Err(RankError { rank: LEADER }),
        }
    }
}

impl Observer for Following<'_> {
    type Error = RankError;

    fn step(&mut self, step: FinishedStep) -> Result<(), RankError> {
        // Where the last step has no fields, the leader writes those of the step before it.
        if step.evaluation.is_some() || !step.is_last {
            self.evaluation = step.evaluation;
        }
        let kept = self.kept(&Checkpoint::default());
        if !self.keeps_fields() {
            self.evaluation = None;
        }
        kept
    }

    fn iteration(&mut self, _: usize, _: &Scalars) -> bool {
        self.kept(&Checkpoint::default()).is_ok()
    }

    fn wants_checkpoint(&self) -> bool {
        true
    }

    fn checkpoint(&mut self, _: usize, state: &Checkpoint) -> Result<(), RankError> {
        self.kept(state)
    }
}
