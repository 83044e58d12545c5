//! Any bytes as a force curve.
#![no_main]

#[path = "../calls.rs"]
#[allow(dead_code)]
mod calls;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    calls::curve(bytes, &std::env::temp_dir());
});
