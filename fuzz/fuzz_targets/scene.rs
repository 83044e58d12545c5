//! Any text as a scene.
#![no_main]

#[path = "../reading.rs"]
#[allow(dead_code)]
mod reading;

use std::path::Path;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let files = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/files"));
    reading::scene(bytes, files);
});
