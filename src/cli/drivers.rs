//! Graphics drivers are asked behind a closed door: what they say while they start goes to nobody,
//! unless the user wants to hear it.
//!
//! Drivers, and the layers that a loader puts before them, print to standard error as they like: that there is
//! no desktop, that an option is unknown. Neither wgpu nor Vulkan has a switch for it, so while adapters are listed and
//! a device is made the descriptor of standard error leads elsewhere. Nothing of tabor's own prints in that
//! time but a second thread that ends the process, which calls [`hear`] first; a panic is caught and its
//! words are said afterwards. With `--verbose` nothing is redirected, so that even a driver that aborts is heard.

use crate::backend::gpu::{AdapterChoice, AdapterDescription, GpuDevice, GpuError, adapters};

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
    door::close();
    // Nothing of what was half done is looked at again.
    let done = std::panic::catch_unwind(std::panic::AssertUnwindSafe(work));
    door::open();
    done.unwrap_or_else(|panic| {
        let words = panic.downcast_ref::<String>().map(String::as_str);
        let words = words.or(panic.downcast_ref::<&str>().copied());
        super::fail(words.unwrap_or("a graphics driver failed"));
        std::panic::resume_unwind(panic)
    })
}

/// Makes sure that standard error leads where it led when the program began.
pub(super) fn hear() {
    door::open();
}

#[cfg(unix)]
mod door {
    use std::fs::File;
    use std::os::fd::OwnedFd;
    use std::sync::{Mutex, PoisonError};

    /// Where standard error leads, while it is led elsewhere.
    static KEPT: Mutex<Option<OwnedFd>> = Mutex::new(None);

    /// Leads standard error to nowhere. Where the system refuses, it stays what it is.
    pub fn close() {
        let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
        let Ok(nowhere) = File::options().write(true).open("/dev/null") else {
            return;
        };
        // A copy that children do not get.
        let copy = rustix::io::fcntl_dupfd_cloexec(std::io::stderr(), 3);
        if let (None, Ok(copy)) = (&*kept, copy)
            && rustix::stdio::dup2_stderr(&nowhere).is_ok()
        {
            *kept = Some(copy);
        }
    }

    /// Leads it back.
    pub fn open() {
        let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(stderr) = kept.take() {
            // What was open a moment ago can be opened again, or nothing can be said of it.
            let _ = rustix::stdio::dup2_stderr(&stderr);
        }
    }
}

/// Elsewhere drivers have no standard error of ours to print to.
#[cfg(not(unix))]
mod door {
    pub fn close() {}
    pub fn open() {}
}
