//! Closed forms and models of contact against tables, studies and force curves.

mod advice;
mod checks;
mod dmt_study;
mod fit;
mod fit_light;
mod fit_relaxation;
#[path = "../shared/mod.rs"]
mod shared;
