//! Many solves: the steps of a loading path.

mod conductance;
pub mod control;
mod cost;
mod dmt;
mod edge;
mod evaluation;
mod flow;
mod hand_over;
mod jumps;
mod memory;
mod observer;
mod plan;
mod rate;
mod relaxation;
mod row;
mod setup;
mod step;
mod walk;
mod wear;

pub use cost::Cost;
pub use dmt::attraction_across;
pub use evaluation::{Evaluation, PointState, Solved};
pub use hand_over::{Earlier, HandOver, HandedField};
pub use jumps::{Jump, dissipation};
pub use memory::Memory;
pub use observer::{FinishedStep, Observer, WalkEnd, WalkError};
pub use plan::{Plan, Regime};
pub use relaxation::{History, branch_coefficients, effective_modulus};
pub use row::{Column, State, StepRow};
pub use setup::{Setup, resolve_law};
pub use walk::{walk, walk_on};
