//! Adapters and devices, without the words of their drivers unless the user wants to hear them.
//!
//! Nothing of tabor's own prints while they start but a second thread that ends the process, which calls
//! [`restore_standard_error`](crate::backend::gpu::restore_standard_error) first. With `verbose` nothing is
//! redirected, so that even a driver that aborts is heard.

use crate::backend::gpu::{
    AdapterChoice, AdapterDescription, GpuDevice, GpuError, adapters, quietly,
};

/// All adapters that drivers offer here. Drivers that print while they start are heard if `verbose`.
pub fn list(verbose: bool) -> Vec<AdapterDescription> {
    quietly_unless(verbose, adapters)
}

/// A device on the adapter of a choice.
///
/// # Errors
/// As [`GpuDevice::new`].
pub fn open(choice: &AdapterChoice, verbose: bool) -> Result<GpuDevice, GpuError> {
    quietly_unless(verbose, || GpuDevice::new(choice))
}

/// Does something that makes drivers talk.
fn quietly_unless<R>(verbose: bool, work: impl FnOnce() -> R) -> R {
    if verbose {
        return work();
    }
    quietly(work).unwrap_or_else(|panic| {
        // Nobody has seen the words of the first panic: this one repeats them where they are seen.
        let words = panic.downcast_ref::<String>().map(String::as_str);
        let words = words.or(panic.downcast_ref::<&str>().copied());
        panic!("{}", words.unwrap_or("a graphics driver failed"))
    })
}
