//! Time of a test's work on a machine that is busy with other things.

use std::time::{Duration, Instant};

use cpu_time::ProcessTime;

/// Began with some work.
pub(super) struct Clock {
    began: Instant,
    worked: ProcessTime,
}

impl Clock {
    pub fn start() -> Self {
        Clock {
            began: Instant::now(),
            worked: ProcessTime::now(),
        }
    }

    /// Processor time of the process, which other tests only lengthen, or the time passed where that is less.
    pub fn elapsed(&self) -> Duration {
        self.began.elapsed().min(self.worked.elapsed())
    }
}
