//! Many solves: the steps of a loading path.
//!
//! [`walk`] drives them and calls the hooks of the scene's effects; it knows none of them by name.

mod across;
mod attempt;
mod between;
mod checkpoint;
pub mod control;
mod cost;
mod cut_edges;
mod evaluation;
mod hooks;
mod hysteresis;
mod jumps;
mod memory;
mod observer;
mod path;
mod perimeter;
mod plan;
mod planned;
mod plausible;
mod pull_off;
mod regime;
mod row;
mod setup;
mod start;
mod step;
mod step_warnings;
mod walker;

pub(crate) use across::held_across;
pub use across::{attraction_across, greatest_across};
pub use between::Search;
pub use checkpoint::{Checkpoint, CheckpointField, Earlier};
pub use cost::Cost;
pub use evaluation::{Evaluation, PointState, Solved};
pub use hooks::HostBytes;
pub use jumps::{Jump, dissipation};
pub use memory::Memory;
pub use observer::{FinishedStep, Observer, Unreachable, WalkEnd, WalkError};
pub(crate) use path::Walk;
pub use path::{walk, walk_on};
#[cfg(feature = "cli")]
pub(crate) use plan::PIXELS_A_WAVE;
pub use plan::Plan;
#[cfg(feature = "cli")]
pub(crate) use plausible::of_surface as implausible_surface;
pub use pull_off::{PullOff, Tension};
pub use regime::{AUTO_TAPER, Regime, resolve_law};
pub(crate) use row::largest_contact;
pub use row::{Column, State, StepRow};
pub use setup::Setup;
pub use step_warnings::step_warnings;

pub(crate) use attempt::Attempt;
pub(crate) use hooks::{Carry, Effects, Hooks, Sizes};
pub(crate) use memory::{DOUBLE, EVALUATION};
pub(crate) use planned::{Planned, count_of_steps};
pub(crate) use step::{SolvedStep, separated};
