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
mod picture;
mod provider;
mod reference;
mod report;
mod richardson;
mod setting;
mod steps;
mod study;
mod table;

pub use error::AccuracyError;
pub use pareto::pareto;
pub use picture::picture;
pub use provider::{BackendProvider, Listener, ProvidedBackend};
pub use report::{Report, duration};
pub use study::Study;
pub use table::{expect_place, screen, write_csv};
