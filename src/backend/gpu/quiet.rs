//! Graphics drivers kept from printing while they start.
//!
//! Drivers, and the layers that a loader puts before them, print to standard error as they like: that there is
//! no desktop, that an option is unknown. Neither wgpu nor Vulkan has a switch for it, so while adapters are
//! listed and a device is made the descriptor of standard error leads elsewhere.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread;

/// Does something that makes drivers print, and returns it without their words. Whatever else prints to
/// standard error meanwhile is not heard either; of a panic its payload is returned.
///
/// # Errors
/// The payload of a panic, which nobody has seen.
pub fn quietly<R>(work: impl FnOnce() -> R) -> thread::Result<R> {
    door::close();
    // Nothing of what was half done is looked at again.
    let done = catch_unwind(AssertUnwindSafe(work));
    door::open();
    done
}

/// Makes sure that standard error leads where it led when the program began.
pub fn restore_standard_error() {
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
