//! Any text as a scene whose models are compared.
#![no_main]

#[path = "../calls.rs"]
#[allow(dead_code)]
mod calls;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    calls::compare(bytes, &std::env::temp_dir());
});
