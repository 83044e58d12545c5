//! The full field against closed forms and independent tables.

mod bench;
mod capillary;
mod controls;
mod energy;
mod friction;
mod hardness;
mod halving;
mod hertz;
mod invariants;
mod layer;
mod lennard_jones;
mod maugis_dugdale;
mod pairs;
mod pattern;
mod relaxation;
mod rough;
mod tables;
mod waves;
