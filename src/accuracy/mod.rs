//! Error against run time: a scene over grids, tolerances, precisions, tapers, step counts,
//! backends and models.
//!
//! | question | file |
//! |---|---|
//! | which settings are tried | `setting`, `steps` |
//! | the same surface on every grid | `same_surface` |
//! | which quantities are compared | `measure`, `cells`, `judge` |
//! | with which reference | `reference`: `closed`, or `richardson` on finer grids |
//! | which settings the time allows, on which backend | `study`, `grids`, `forecast`; `workplace` |
//! | which settings are worth their time | `front` |
//! | results and their display | `report`; `table`, `picture` |

mod cells;
mod closed;
mod error;
mod forecast;
mod front;
mod grids;
mod judge;
mod measure;
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

pub use cells::means;
pub use closed::closed;
pub use error::AccuracyError;
pub use front::{cheapest, pareto};
pub use grids::LEAST_POINTS;
pub use judge::Errors;
pub use measure::{Measured, Point};
pub use picture::picture;
pub use reference::Reference;
pub use report::{LeftOut, Report, Row, duration};
pub use richardson::{Extrapolated, extrapolate};
pub use same_surface::SameSurface;
pub use setting::{Model, Setting, Taper, Varied, others};
pub use steps::{Steps, Walk};
pub use study::Study;
pub use table::{LEVELS, csv, expect_place, screen, write_csv};
pub use workplace::{Bench, Listener, Workplace};
