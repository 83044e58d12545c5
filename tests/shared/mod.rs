//! What test binaries share.

#![allow(dead_code, reason = "each test binary uses its part")]

pub mod binary;
pub mod device;
pub mod random;
pub mod run_folder;
pub mod trials;
