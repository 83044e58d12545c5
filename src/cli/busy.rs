//! What tests of many chance calls share: their number, and the time of one on a machine that is busy with other
//! things.

use std::time::{Duration, Instant};

use cpu_time::ProcessTime;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// The number of cases, `usual` or what `TABOR_MUTATIONS` says, and what runs them: the same in every run, more of them
/// begin with the fewer.
pub(super) fn cases(usual: u32) -> (u32, TestRunner) {
    let cases = std::env::var("TABOR_MUTATIONS").map_or(usual, |text| {
        text.parse().expect("TABOR_MUTATIONS is a number of cases")
    });
    let config = Config {
        cases,
        failure_persistence: None,
        max_shrink_iters: 200,
        ..Config::default()
    };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    (cases, TestRunner::new_with_rng(config, rng))
}

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
