//! Checkpoint of a path, from which another process resumes.

use std::sync::Arc;

use super::evaluation::PointState;
use super::pull_off::PullOff;
use super::row::StepRow;
use crate::backend::long_field::LongField;

/// The name of the gap among the fields of a checkpoint.
pub(super) const GAP: &str = "gap";

/// Values that the next step starts from.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckpointField {
    /// Which ones.
    pub name: String,
    /// Over all solved points, reduced, as precise as the backend holds them.
    pub values: Arc<LongField<f64>>,
}

/// The state from which the step after a converged one starts, and the totals of the steps so far that are
/// not in their rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Checkpoint {
    /// Fields of the solver and of effects; no gap where the surfaces are separated and the next step starts
    /// from undeformed heights. The solver keeps no direction between steps.
    pub fields: Vec<CheckpointField>,
    /// The stiffness of the zero mode under which the pressure of the gap has been evaluated, if the next step
    /// needs no evaluation of it.
    pub evaluated_under: Option<f64>,
    /// State of each point of the grid, where steps are watched for jumps.
    pub points: Option<Vec<PointState>>,
    /// Steps so far that jumped into contact.
    pub jump_in_steps: Vec<usize>,
    /// Steps so far that jumped off.
    pub jump_off_steps: Vec<usize>,
    /// The greatest pull-off so far of contacts that let go under a prescribed load.
    pub pull_off: Option<PullOff>,
    /// Real two-dimensional transforms so far.
    pub transforms: f64,
}

/// The steps of a path that are done already.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Earlier {
    /// Their rows.
    pub rows: Vec<StepRow>,
    /// The state after the last of them.
    pub checkpoint: Checkpoint,
}

impl Checkpoint {
    /// The values of a field, if it is there.
    pub fn field(&self, name: &str) -> Option<&[f64]> {
        let found = self.fields.iter().find(|field| field.name == name);
        found.map(|field| &**field.values)
    }

    /// The same without a copy, for who keeps them.
    pub(crate) fn shared(&self, name: &str) -> Option<Arc<LongField<f64>>> {
        let found = self.fields.iter().find(|field| field.name == name);
        found.map(|field| Arc::clone(&field.values))
    }
}

impl PointState {
    /// The state of a number that `as u8` made.
    pub fn from_byte(byte: u8) -> Option<PointState> {
        [
            PointState::Separated,
            PointState::Attracted,
            PointState::Contact,
        ]
        .into_iter()
        .find(|state| *state as u8 == byte)
    }
}
