//! Closed forms and models of contact against tables, studies and force curves.

mod advice;
mod checks;
mod dmt_study;
mod fit;
mod fit_choice;
mod fit_exact;
mod fit_inversion;
mod fit_light;
mod fit_relaxation;
mod fit_scatter;
mod fit_signs;
mod fit_slope;
mod flow;
mod lennard_jones_sphere;
#[path = "../shared/mod.rs"]
mod shared;
#[path = "../../src/fit/test_noise.rs"]
mod test_noise;
