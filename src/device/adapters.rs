//! Adapters and devices, without the words of their drivers unless the user wants to hear them.
//!
//! Nothing of tabor's own prints while they start but a second thread that ends the process, which calls
//! [`restore_standard_error`](crate::backend::gpu::restore_standard_error) first. With `verbose` nothing is
//! redirected, so that even a driver that aborts is heard.

use std::sync::{Mutex, PoisonError};

use crate::backend::gpu::{
    AdapterChoice, AdapterDescription, GpuDevice, GpuError, adapters, quietly,
};

/// All adapters that drivers offer here, as this process found them when it first asked: many runs in one process ask
/// for the same. Drivers that print while they start are heard if `verbose`.
pub fn list(verbose: bool) -> Vec<AdapterDescription> {
    static FOUND: Mutex<Option<Vec<AdapterDescription>>> = Mutex::new(None);
    let mut found = FOUND.lock().unwrap_or_else(PoisonError::into_inner);
    match &*found {
        Some(found) if !verbose => found.clone(),
        _ => found.insert(quietly_unless(verbose, adapters)).clone(),
    }
}

/// A device on the adapter of a choice: the one that this process has opened for the same choice, with the
/// kernels that it has compiled, or a new one. A device that is made to fail is always new.
///
/// # Errors
/// As [`GpuDevice::new`].
pub fn open(choice: &AdapterChoice, verbose: bool) -> Result<GpuDevice, GpuError> {
    let new = || quietly_unless(verbose, || GpuDevice::new(choice));
    if choice.injects_faults() {
        return new();
    }
    static OPEN: Mutex<Vec<(AdapterChoice, GpuDevice)>> = Mutex::new(Vec::new());
    let mut open = OPEN.lock().unwrap_or_else(PoisonError::into_inner);
    // A device that was lost stays lost.
    open.retain(|(_, device)| !device.is_lost());
    if let Some((_, device)) = open.iter().find(|(made_for, _)| made_for == choice) {
        return Ok(device.clone());
    }
    let device = new()?;
    open.push((choice.clone(), device.clone()));
    Ok(device)
}

/// Does something that makes drivers talk; one thread at a time, since standard error is the whole process's.
fn quietly_unless<R>(verbose: bool, work: impl FnOnce() -> R) -> R {
    static QUIET: Mutex<()> = Mutex::new(());
    let _only = QUIET.lock().unwrap_or_else(PoisonError::into_inner);
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
