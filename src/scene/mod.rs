//! Scenes: TOML in, a checked [`Scene`] out.

mod types;

pub use types::*;
