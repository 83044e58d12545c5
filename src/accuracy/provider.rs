//! Interfaces of a study: where settings run, and who observes it.

use super::error::AccuracyError;
use super::report::Report;
use crate::backend::Backend;
use crate::grid::Grid;
use crate::scene::{BackendName, Precision, Scene};
use crate::study::Setup;

/// A backend for one setting.
pub struct ProvidedBackend {
    /// Creates the backend.
    pub make: Box<dyn Fn() -> Box<dyn Backend + Send> + Send + Sync>,
    /// A note for the user.
    pub remark: Option<String>,
}

/// Provides backends for settings.
pub trait BackendProvider: Sync {
    /// Available backends and precisions.
    fn arithmetics(&self) -> &[(BackendName, Precision)];
    /// Checks that memory suffices for a scene on a grid.
    ///
    /// # Errors
    /// A message for the user.
    fn fits(&self, scene: &Scene, grid: Grid) -> Result<(), String>;
    /// A backend for a setup.
    ///
    /// # Errors
    /// A message for the user.
    fn provide(&self, setup: &Setup) -> Result<ProvidedBackend, String>;
}

/// Observes a study.
pub trait Listener: Send {
    /// A run begins; it will take about this many seconds.
    fn begins(&mut self, words: &str, seconds: f64);
    /// Called at each iteration; `false` ends the study.
    fn iteration(&mut self, step: usize, iteration: usize, residual: f64) -> bool;
    /// A note for the user.
    fn note(&mut self, text: &str);
    /// A row is finished; the report contains all rows so far.
    ///
    /// # Errors
    /// The row cannot be stored.
    fn row(&mut self, report: &Report) -> Result<(), AccuracyError>;
}
