//! The one algorithm: nonlinear conjugate gradients in the gap, for every law and both boundaries.
//!
//! The unknown is the gap g over the rigid heights h; the surface displacement is u = g + h and
//! the elastic pressure p = K*u. With y = p + mean_pressure + sigma(g), a solution has y >= 0 where
//! the gap is closed (there y is the wall's reaction) and y = 0 where it is open. It is a stationary
//! point of `<u, Ku>/2 + <V(g)> + mean_pressure <g>`, which each accepted step lowers.
//!
//! [`plain`] tells the method in plain arrays; [`ContactSolver`] carries it out on a backend.

mod borrowed;
mod coarse_start;
mod contact;
mod elasticity;
mod heights;
mod incremental_stiffness;
mod iteration;
mod kernel_set;
mod load;
mod mean_gap;
mod moved_heights;
mod multilevel;
mod outer_state;
pub mod plain;
mod plain_setup;
mod problem;
mod refinement;
mod rigid;
mod stiffness;

pub use contact::{ContactSolver, ROUNDS_PER_ITERATION};
pub use heights::Heights;
pub use load::{Hold, Load, Outcome, Start};
pub use outer_state::plan_outer_state;
pub use problem::{Problem, Scales, good_size, solved_shape};
pub use refinement::{MOST_ROUNDS, TRIALS_PER_ITERATION, works_in_turn};

/// Where solvers get their backends from; one a level of a coarse start.
pub type MakeBackend<'a> = &'a dyn Fn() -> Box<dyn crate::backend::Backend + Send>;
