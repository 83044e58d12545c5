//! Surfaces: generated ones against closed forms, and files against what other readers find in them.

mod generated;
mod height_files;
#[path = "../shared/mod.rs"]
mod shared;
