//! The full field against closed forms and independent tables.

mod bench;
mod capillary;
mod conductance;
mod controls;
mod energy;
mod friction;
mod halving;
mod hardness;
mod hertz;
mod invariants;
mod layer;
mod lennard_jones;
mod maugis_dugdale;
mod pairs;
mod pattern;
mod plates;
mod rate;
mod relaxation;
mod rough;
mod spring;
mod tables;
mod time_steps;
mod waves;
mod wear;
