//! Work on a thread of its own, while Python's waits and hears signals.
//!
//! Python tells signals to its main thread only, and only while that runs Python's own code. So the solver gets
//! another thread, and the one that called waits without the interpreter's lock and looks for signals now and then.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;

use crate::errors;

/// How often signals are looked for: a tenth of the second that Ctrl-C may take.
const POLL: Duration = Duration::from_millis(100);

/// What a solver and those who wait for it tell each other.
#[derive(Default)]
pub struct Talk {
    /// Whether the solver shall end.
    pub stop: AtomicBool,
    iteration: AtomicUsize,
    /// The bits of the residual.
    residual: AtomicU64,
    /// Steps that are finished.
    finished: AtomicUsize,
}

impl Talk {
    /// Tells of an iteration; whether to go on.
    pub fn iteration(&self, iteration: usize, residual: f64) -> bool {
        self.iteration.store(iteration, Ordering::Relaxed);
        self.residual.store(residual.to_bits(), Ordering::Relaxed);
        self.goes_on()
    }

    /// Forgets the iterations of the load before.
    pub fn begin(&self) {
        self.iteration.store(0, Ordering::Relaxed);
    }

    /// Whether somebody still waits.
    pub fn goes_on(&self) -> bool {
        !self.stop.load(Ordering::Relaxed)
    }

    /// Tells how many steps are finished.
    pub fn finished(&self, steps: usize) {
        self.finished.store(steps, Ordering::Relaxed);
    }

    /// Finished steps, the last iteration that was told of, 0 for none, and its residual.
    pub fn last(&self) -> (usize, usize, f64) {
        let residual = f64::from_bits(self.residual.load(Ordering::Relaxed));
        let [finished, iteration] =
            [&self.finished, &self.iteration].map(|count| count.load(Ordering::Relaxed));
        (finished, iteration, residual)
    }
}

/// What becomes of work that is told to stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stopped {
    /// It ends at its next iteration, and its result is dropped.
    LeftBehind,
    /// It is waited for, unless a second signal raises.
    Joined,
}

/// Does `work` on another thread, and tells `progress` of its iterations, of the last one in any case. Where a signal or
/// `progress` raises, the work is told to stop and left behind: it ends at its next iteration, and its result is dropped.
pub fn wait<R: Send + 'static>(
    py: Python<'_>,
    talk: &Arc<Talk>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce() -> R + Send + 'static,
) -> PyResult<R> {
    wait_or(Stopped::LeftBehind, py, talk, progress, work)
}

/// The same for work that writes files: where a signal or `progress` raises, the work has ended when this returns, and
/// has written what it has. A second signal leaves it behind.
pub fn wait_and_join<R: Send + 'static>(
    py: Python<'_>,
    talk: &Arc<Talk>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce() -> R + Send + 'static,
) -> PyResult<R> {
    wait_or(Stopped::Joined, py, talk, progress, work)
}

fn wait_or<R: Send + 'static>(
    stopped: Stopped,
    py: Python<'_>,
    talk: &Arc<Talk>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce() -> R + Send + 'static,
) -> PyResult<R> {
    let (sender, mut receiver) = channel();
    let spawned = thread::Builder::new()
        .name("tabor".to_owned())
        .spawn(move || {
            // Nobody may be waiting any more.
            let _ = sender.send(catch_unwind(AssertUnwindSafe(work)));
        });
    spawned.map_err(|error| errors::failed(py, &format!("no thread for the solver: {error}")))?;
    let mut told = (talk.last().0, 0);
    let mut tell = || -> PyResult<()> {
        let (finished, iteration, residual) = talk.last();
        if let Some(progress) = progress
            && (finished, iteration) != told
        {
            told = (finished, iteration);
            progress.call1((finished, iteration, residual))?;
        }
        Ok(())
    };
    loop {
        let (received, back) = py.detach(move || (receiver.recv_timeout(POLL), receiver));
        receiver = back;
        match received {
            Ok(Ok(result)) => return tell().map(|()| result),
            Ok(Err(_)) | Err(RecvTimeoutError::Disconnected) => {
                return Err(errors::failed(
                    py,
                    "tabor failed within itself; please report it",
                ));
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
        let heard = py.check_signals().and_then(|()| tell());
        if let Err(raised) = heard {
            talk.stop.store(true, Ordering::Relaxed);
            if stopped == Stopped::Joined {
                join(py, receiver)?;
            }
            return Err(raised);
        }
    }
}

/// Waits until the work has ended, or a signal raises.
fn join<T: Send>(py: Python<'_>, mut receiver: Receiver<T>) -> PyResult<()> {
    loop {
        let (received, back) = py.detach(move || (receiver.recv_timeout(POLL), receiver));
        receiver = back;
        if !matches!(received, Err(RecvTimeoutError::Timeout)) {
            return Ok(());
        }
        py.check_signals()?;
    }
}
