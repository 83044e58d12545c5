//! Time of a test's work on a machine that is busy with other things.

use std::time::{Duration, Instant};

use crate::output::cpu_seconds;

/// Began with some work.
pub(super) struct Clock {
    began: Instant,
    worked: Option<f64>,
}

impl Clock {
    pub fn start() -> Self {
        Clock {
            began: Instant::now(),
            worked: cpu_seconds(),
        }
    }

    /// Processor time of the process where the system tells, which other tests only lengthen, or the time
    /// passed where that is less.
    pub fn elapsed(&self) -> Duration {
        let passed = self.began.elapsed();
        let worked = self.worked.zip(cpu_seconds());
        worked.map_or(passed, |(before, now)| {
            passed.min(Duration::from_secs_f64((now - before).max(0.0)))
        })
    }
}
