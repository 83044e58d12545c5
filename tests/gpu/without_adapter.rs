//! What these tests say where no adapter is found.

use std::process::Command;

use crate::shared::binary::{NO_DRIVERS, with_drivers};
use crate::shared::device::device;
use crate::shared::trials::{expect_ignored, ignore, tests};

/// One that asks for the device first.
const TEST: &str = "convolution::a_shut_gate_leaves_everything_as_it_was";

/// Ends the test where drivers are found that do not listen to Vulkan's variables.
fn leave_other_drivers() {
    if cfg!(any(target_os = "macos", target_os = "windows")) {
        ignore("adapters here are not Vulkan's, and cannot be hidden");
    }
}

fn a_test_without_an_adapter_is_ignored_with_its_reason() {
    leave_other_drivers();
    let hidden = [
        ("VK_DRIVER_FILES", NO_DRIVERS),
        ("VK_ICD_FILENAMES", NO_DRIVERS),
    ];
    expect_ignored(TEST, &hidden, "no adapter");
}

fn a_test_without_the_adapter_that_is_required_fails() {
    leave_other_drivers();
    let mut command = Command::new(std::env::current_exe().expect("this binary"));
    let output = with_drivers(command.args(["--exact", TEST]), NO_DRIVERS)
        .env("TABOR_REQUIRE_GPU", "1")
        .output()
        .expect("this binary runs");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(!output.status.success(), "{said}");
    assert!(said.contains("0 passed; 1 failed; 0 ignored"), "{said}");
}

/// And where there is one the test runs: it is not the name that is ignored.
fn a_test_with_an_adapter_runs() {
    device();
    let output = Command::new(std::env::current_exe().expect("this binary"))
        .args(["--exact", TEST])
        .output()
        .expect("this binary runs");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("1 passed; 0 failed; 0 ignored"), "{said}");
}

tests![
    a_test_without_an_adapter_is_ignored_with_its_reason,
    a_test_without_the_adapter_that_is_required_fails,
    a_test_with_an_adapter_runs,
];
