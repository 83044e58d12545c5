//! Many solves: the steps of a loading path.

mod between;
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
mod path;
mod plan;
mod pull_off;
mod rate;
mod relaxation;
mod row;
mod setup;
mod step;
mod walker;
mod wear;

pub use between::Search;
pub use cost::Cost;
pub use dmt::{attraction_across, greatest_across};
pub use evaluation::{Evaluation, PointState, Solved};
pub use hand_over::{Earlier, HandOver, HandedField};
pub use jumps::{Jump, dissipation};
pub use memory::Memory;
pub use observer::{FinishedStep, Observer, Unreachable, WalkEnd, WalkError};
pub use path::{walk, walk_on};
pub use plan::{Plan, Regime};
pub use pull_off::{PullOff, Tension};
pub use relaxation::{History, branch_coefficients, effective_modulus};
pub use row::{Column, State, StepRow};
pub use setup::{AUTO_TAPER, Setup, resolve_law};
