//! Keeps graphics drivers from printing while they start.
//!
//! Drivers, and the layers that a loader puts before them, print to standard error as they like: that there is
//! no desktop, that an option is unknown. Neither wgpu nor Vulkan has a switch for it, so while adapters are
//! listed and a device is made the descriptor of standard error leads elsewhere.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread;

/// Calls a function during which drivers print, with standard error discarded, other output to it included.
/// Returns its result or the payload of its panic.
///
/// # Errors
/// The payload of a panic, whose message was discarded.
pub fn quietly<R>(work: impl FnOnce() -> R) -> thread::Result<R> {
    redirect::discard();
    // Nothing that the panic left unfinished is used again.
    let done = catch_unwind(AssertUnwindSafe(work));
    redirect::restore();
    done
}

/// Restores standard error if it is discarded at present.
pub fn restore_standard_error() {
    redirect::restore();
}

#[cfg(unix)]
mod redirect {
    use std::fs::File;
    use std::os::fd::OwnedFd;
    use std::sync::{Mutex, PoisonError};

    /// The original standard error, while it is discarded.
    static ORIGINAL: Mutex<Option<OwnedFd>> = Mutex::new(None);

    /// Discards standard error; without effect where the system refuses.
    pub fn discard() {
        let mut kept = ORIGINAL.lock().unwrap_or_else(PoisonError::into_inner);
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

    /// Restores it.
    pub fn restore() {
        let mut kept = ORIGINAL.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(stderr) = kept.take() {
            // Opening it again fails only where no message could be printed either.
            let _ = rustix::stdio::dup2_stderr(&stderr);
        }
    }
}

/// Elsewhere drivers have no standard error of ours to print to.
#[cfg(not(unix))]
mod redirect {
    pub fn discard() {}
    pub fn restore() {}
}
