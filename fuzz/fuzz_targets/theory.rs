//! Any words as a call of `tabor theory`.
#![no_main]

#[path = "../calls.rs"]
#[allow(dead_code)]
mod calls;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    calls::theory(bytes);
});
