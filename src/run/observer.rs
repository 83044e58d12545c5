//! The progress of a run, for whoever shows or ends it.

use crate::study::StepRow;

/// Is told the progress of a run, and may end it. Every method has a default that does nothing.
///
/// `()` ignores everything and never ends a run.
pub trait RunObserver: Send {
    /// The surface is built and the device is ready, in words such as `cpu, double precision`; the folder is
    /// opened next. Called again where another device continues.
    fn starts(&mut self, _device: &str) {}

    /// Something to know, in words.
    fn note(&mut self, _text: &str) {}

    /// A warning, in words; it is in the summary too.
    fn warning(&mut self, _text: &str) {}

    /// The steps begin, of which some are `finished` already where a run is resumed or continues on another
    /// device; each is solved to `tolerance`.
    fn begins(&mut self, _steps: usize, _finished: usize, _tolerance: f64) {}

    /// An iteration of a step (from 1) is done; returns whether to continue. A run that is ended here has
    /// [`RunStatus::Interrupted`](super::RunStatus::Interrupted).
    fn iteration(&mut self, _step: usize, _iteration: usize, _residual: f64) -> bool {
        true
    }

    /// A search between a step and the one before it, in words. The iterations that follow are of
    /// loads in between.
    fn search(&mut self, _step: usize, _words: &str) {}

    /// A step is on the disk.
    fn step(&mut self, _row: &StepRow) {}

    /// What is kept if the process ends now, in words.
    fn kept(&mut self, _words: &str) {}

    /// The run ended before its last step, and this is kept, in words.
    fn ended_early(&mut self, _kept: &str) {}
}

impl RunObserver for () {}
