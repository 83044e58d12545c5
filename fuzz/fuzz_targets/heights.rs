//! Any bytes as a height file.
#![no_main]

#[path = "../reading.rs"]
#[allow(dead_code)]
mod reading;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| reading::heights(bytes, &std::env::temp_dir()));
