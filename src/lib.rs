//! tabor solves adhesive contact of rough surfaces as a full field: how much really touches, with
//! what pressure where, and what force pulls the surfaces apart.
#![warn(missing_docs)]

pub mod backend;
pub mod cli;
pub mod effect;
pub mod elastic;
pub mod grid;
pub mod kernel;
pub mod law;
pub mod output;
pub mod real;
pub mod scene;
pub mod solver;
pub mod study;
pub mod surface;
pub mod theory;
pub mod units;
