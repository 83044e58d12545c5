//! A study of many runs: one scene over values of its keys, one table out.
//!
//! [`Study`] reads a study file and lists its cases, [`solve`](fn@solve) runs them on some threads and keeps
//! each result as it ends, and [`SweepFolder`] holds what is kept: one line for each case that ended, from which the
//! tables and the picture are made. A study that was interrupted continues where it was.

mod axis;
mod cases;
mod error;
mod folder;
mod means;
mod outcome;
mod picture;
mod solve;
mod study;
mod tables;

pub use cases::{Share, command};
pub use error::SweepError;
pub use folder::SweepFolder;
pub use outcome::Outcome;
pub use solve::{Jobs, Listener, solve};
pub use study::Study;
