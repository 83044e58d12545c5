//! A word on standard error from a command that takes long and has no bar.

use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

use super::say;

/// Time after which a command says that it is at work, and again each time it has doubled.
const SILENCE: Duration = Duration::from_secs(5);

/// Says so until it is dropped.
pub(super) struct Patience(#[allow(dead_code, reason = "its end is the message")] Sender<()>);

impl Patience {
    /// Begins to wait; `remedy` is what would take less time.
    pub fn new(remedy: &'static str) -> Self {
        let (end, ended) = channel();
        thread::spawn(move || {
            let mut seconds = SILENCE;
            let mut wait = SILENCE;
            while ended.recv_timeout(wait) == Err(RecvTimeoutError::Timeout) {
                say(&format!(
                    "note: at work for {} s; {remedy}",
                    seconds.as_secs()
                ));
                wait = seconds;
                seconds += wait;
            }
        });
        Patience(end)
    }
}
