//! Who hears how far a run is.

use crate::study::StepRow;

/// Hears how far a run is, and may end it. Every method has a default that does nothing.
///
/// `()` hears nothing and ends nothing.
pub trait RunObserver: Send {
    /// The surface is built and the device is ready, in words such as `cpu, double precision`; the folder is
    /// opened next. Comes again where another device goes on.
    fn starts(&mut self, _device: &str) {}

    /// Something to know, in words.
    fn note(&mut self, _text: &str) {}

    /// A warning, in words; it is in the summary too.
    fn warning(&mut self, _text: &str) {}

    /// The steps begin, of which some are `finished` already where a run is resumed or goes on on another
    /// device; each is solved to `tolerance`.
    fn begins(&mut self, _steps: usize, _finished: usize, _tolerance: f64) {}

    /// An iteration of a step (from 1) is done; returns whether to go on. A run that is ended here has
    /// [`RunStatus::Interrupted`](super::RunStatus::Interrupted).
    fn iteration(&mut self, _step: usize, _iteration: usize, _residual: f64) -> bool {
        true
    }

    /// Something is looked for between a step and the one before, in words. The iterations that follow are of
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
