//! Error against run time: a scene over grids, tolerances, precisions, tapers, step counts,
//! backends and models.
//!
//! | question | file |
//! |---|---|
//! | which settings are tried | `setting`, `steps` |
//! | the same surface on every grid | `grid_independent` |
//! | which quantities are compared | `measure`, `cells`, `errors` |
//! | with which reference | `reference`: `closed_form`, or `richardson` on finer grids |
//! | which settings the time allows, on which backend | `study`, `grids`, `forecast`; `provider` |
//! | which settings are worth their time | `pareto` |
//! | results and their display | `report`; `table`, `picture` |

mod cells;
mod closed_form;
mod error;
mod errors;
mod forecast;
mod grid_independent;
mod grids;
mod measure;
mod pareto;
#[cfg(feature = "images")]
mod picture;
mod provider;
mod reference;
mod report;
mod richardson;
mod setting;
mod steps;
mod study;
mod table;

#[doc(hidden)]
pub use cells::means;
#[doc(hidden)]
pub use closed_form::closed_form;
pub use error::AccuracyError;
pub use errors::Errors;
#[doc(hidden)]
pub use grid_independent::GridIndependentSurface;
#[doc(hidden)]
pub use grids::LEAST_POINTS;
pub use measure::{Measured, Point};
pub use pareto::{cheapest, pareto};
#[cfg(feature = "images")]
pub use picture::picture;
pub use provider::{BackendProvider, Listener, ProvidedBackend};
pub use reference::Reference;
pub use report::{LeftOut, Report, Row, duration};
#[doc(hidden)]
pub use richardson::{Extrapolated, extrapolate};
#[doc(hidden)]
pub use setting::others;
pub use setting::{Model, Setting, Taper, Varied};
#[doc(hidden)]
pub use steps::{PathVariant, Steps};
#[doc(hidden)]
pub use study::Study;
#[doc(hidden)]
pub use table::{LEVELS, csv, expect_place, screen, write_csv};
