//! The full field against closed forms and independent tables.

mod bench;
mod capillary;
mod conductance;
mod controls;
mod dmt;
mod energy;
mod friction;
mod halving;
mod hard_cases;
mod hardness;
mod hertz;
mod invariants;
mod layer;
mod lennard_jones;
mod maugis_dugdale;
mod pairs;
mod pattern;
mod plates;
mod precisions;
mod pull_off;
mod rate;
mod relaxation;
mod rough;
#[path = "../shared/mod.rs"]
mod shared;
mod spring;
mod tables;
mod taper;
mod time_steps;
mod waves;
mod wear;
