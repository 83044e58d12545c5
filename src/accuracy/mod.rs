//! What accuracy costs: a scene over grids, tolerances, precisions, tapers, step counts, backends
//! and models, each with its error and its seconds.
//!
//! | question | file |
//! |---|---|
//! | what is tried | `setting`, `steps` |
//! | is it the same surface on every grid | `same_surface` |
//! | what is compared | `measure`, `cells`, `judge` |
//! | with what | `reference`: `closed`, or `richardson` on finer grids |
//! | what there is time for, and where | `study`, `grids`, `forecast`; `workplace` |
//! | what is worth its seconds | `front` |
//! | what was found, and how it is shown | `report`; `table`, `picture` |

mod cells;
mod closed;
mod error;
mod forecast;
mod front;
mod grids;
mod judge;
mod measure;
#[cfg(feature = "images")]
mod picture;
mod reference;
mod report;
mod richardson;
mod same_surface;
mod setting;
mod steps;
mod study;
mod table;
mod workplace;

#[doc(hidden)]
pub use cells::means;
#[doc(hidden)]
pub use closed::closed;
pub use error::AccuracyError;
pub use front::{cheapest, pareto};
#[doc(hidden)]
pub use grids::LEAST_POINTS;
pub use judge::Errors;
pub use measure::{Measured, Point};
#[cfg(feature = "images")]
pub use picture::picture;
pub use reference::Reference;
pub use report::{LeftOut, Report, Row, duration};
#[doc(hidden)]
pub use richardson::{Extrapolated, extrapolate};
#[doc(hidden)]
pub use same_surface::SameSurface;
#[doc(hidden)]
pub use setting::others;
pub use setting::{Model, Setting, Taper, Varied};
#[doc(hidden)]
pub use steps::{Steps, Walk};
#[doc(hidden)]
pub use study::Study;
#[doc(hidden)]
pub use table::{LEVELS, csv, expect_place, screen, write_csv};
#[doc(hidden)]
pub use workplace::{Bench, Listener, Workplace};
