//! Many solves: the steps of a loading path.

mod row;

pub use row::{State, StepRow};
