//! A contact for people with arrays: heights in, gap and pressure out, everything in SI units.
//!
//! A [`Contact`] holds what touches what; [`Contact::solve`] solves one load, [`Contact::path`] one load after
//! another, each from the state of the one before. Both give [`Solution`]s, whose fields are arrays of shape
//! `[ny, nx]`, row-major: point (ix, iy) is element `iy * nx + ix`, as NumPy and ndarray store `[ny, nx]`.

mod builder;
mod control;
mod error;
mod path;
mod phrases;
mod solution;

pub use builder::Contact;
pub use control::{Control, Load};
pub use error::{ContactError, ContactMistake, ContactMistakes};
pub use path::Path;
pub use solution::Solution;
