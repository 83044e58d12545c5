//! Ctrl-C: a run ends after its present iteration, or at once where the graphics processor keeps it waiting.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use super::{fail, say};
#[cfg(feature = "gpu")]
use crate::backend::gpu::{keeps_waiting, restore_standard_error};

/// Exit status of what a signal ended.
pub(super) const INTERRUPTED: u8 = 130;

/// How long a driver may keep a run from its end. A shader may compile for minutes.
const PATIENCE: Duration = Duration::from_millis(1500);
/// What comes so soon after the first signal is that one again: `timeout` and some shells send it both to a program
/// and to its group.
const ECHO: Duration = Duration::from_millis(300);
/// How often it is looked whether that is over.
const LOOK: Duration = Duration::from_millis(20);

/// What signals have asked of this process.
#[derive(Clone, Debug, Default)]
pub(super) struct Interrupts {
    asked: Arc<Asked>,
}

#[derive(Debug, Default)]
struct Asked {
    /// When the first signal came.
    raised: OnceLock<Instant>,
    /// Whether the run knows, and is about to end by itself.
    seen: AtomicBool,
    /// What an end at once leaves, in words.
    kept: Mutex<String>,
}

impl Interrupts {
    /// Watches for Ctrl-C and the like from here on.
    pub fn watch() -> Interrupts {
        let interrupts = Interrupts::default();
        let asked = Arc::clone(&interrupts.asked);
        // A second handler in one process is refused; then the first one's default stands.
        if let Err(error) = ctrlc::set_handler(move || asked.raise()) {
            super::warn(&format!(
                "Ctrl-C will end the run without a summary: {error}"
            ));
        }
        interrupts
    }

    /// Whether the run is to end; whoever asks and hears so ends it.
    pub fn raised(&self) -> bool {
        let raised = self.asked.raised.get().is_some();
        if raised {
            self.asked.seen.store(true, Ordering::Relaxed);
        }
        raised
    }

    /// Says what an end at once leaves from here on.
    pub fn keep(&self, words: String) {
        *self
            .asked
            .kept
            .lock()
            .unwrap_or_else(PoisonError::into_inner) = words;
    }
}

impl Asked {
    /// A signal came. The second one ends the process at once.
    fn raise(self: &Arc<Self>) {
        let now = Instant::now();
        if let Err(again) = self.raised.set(now) {
            let first = self.raised.get().copied().unwrap_or(again);
            if again.duration_since(first) > ECHO {
                self.end("interrupted twice: ended at once");
            }
            return;
        }
        let asked = Arc::clone(self);
        let watch = move || {
            let since = Instant::now();
            while !asked.seen.load(Ordering::Relaxed) {
                if since.elapsed() >= PATIENCE && keeps_waiting() {
                    asked.end("interrupted while the graphics processor was waited for");
                }
                std::thread::sleep(LOOK);
            }
        };
        // Without a thread for it the run ends once the device answers.
        let _ = std::thread::Builder::new()
            .name("interrupt".to_owned())
            .spawn(watch);
    }

    /// Ends the process. Every file is whole or under its hidden name, and each finished step is on the disk, so that
    /// nothing is lost but what a run writes at its end.
    fn end(&self, why: &str) {
        #[cfg(feature = "gpu")]
        restore_standard_error();
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if !kept.is_empty() {
            say(&kept);
        }
        fail(why);
        leave(INTERRUPTED);
    }
}

/// Nothing but a graphics processor keeps a run from hearing of a signal.
#[cfg(not(feature = "gpu"))]
fn keeps_waiting() -> bool {
    false
}

/// Leaves without the cleaning up of libraries, which would wait for the driver or pull its memory from
/// under it.
#[cfg(unix)]
pub(super) fn leave(status: u8) -> ! {
    signal_hook::low_level::exit(status.into())
}

#[cfg(not(unix))]
pub(super) fn leave(status: u8) -> ! {
    std::process::exit(status.into())
}
