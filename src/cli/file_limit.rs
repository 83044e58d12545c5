//! Limits on the length of files.

/// Has the system refuse what goes beyond a limit on the length of files (`ulimit -f`), as it refuses what a full
/// disk does not hold, in place of ending the program.
#[cfg(unix)]
pub(super) fn survive() {
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;
    let noted = Arc::new(AtomicBool::new(false));
    // Where it cannot be had, the signal ends the program as it would have.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, noted);
}

#[cfg(not(unix))]
pub(super) fn survive() {}
