//! Adapters and devices, without the words of their drivers unless the user wants to hear them.
//!
//! Nothing of tabor's own prints while they start but a second thread that ends the process, which calls
//! [`hear`] first; a panic is caught and its words are said afterwards. With `--verbose` nothing is redirected,
//! so that even a driver that aborts is heard.

use crate::backend::gpu::{
    AdapterChoice, AdapterDescription, GpuDevice, GpuError, adapters, quietly,
    restore_standard_error,
};

/// All adapters that drivers offer here.
pub(super) fn list(verbose: bool) -> Vec<AdapterDescription> {
    hushed(verbose, adapters)
}

/// A device on the adapter of a choice.
pub(super) fn device(choice: &AdapterChoice, verbose: bool) -> Result<GpuDevice, GpuError> {
    hushed(verbose, || GpuDevice::new(choice))
}

/// Does something that makes drivers talk.
fn hushed<R>(verbose: bool, work: impl FnOnce() -> R) -> R {
    if verbose {
        return work();
    }
    quietly(work).unwrap_or_else(|panic| {
        let words = panic.downcast_ref::<String>().map(String::as_str);
        let words = words.or(panic.downcast_ref::<&str>().copied());
        super::fail(words.unwrap_or("a graphics driver failed"));
        std::panic::resume_unwind(panic)
    })
}

/// Makes sure that standard error leads where it led when the program began.
pub(super) fn hear() {
    restore_standard_error();
}
