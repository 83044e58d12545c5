//! Where settings are run, and who watches.

use super::error::AccuracyError;
use super::report::Report;
use crate::backend::Backend;
use crate::grid::Grid;
use crate::scene::{BackendName, Precision, Scene};
use crate::study::Setup;

/// A backend for one setting.
pub struct Bench {
    /// Makes one.
    pub make: Box<dyn Fn() -> Box<dyn Backend + Send> + Send + Sync>,
    /// What the user should know about it.
    pub remark: Option<String>,
}

/// Where settings are run.
pub trait Workplace: Sync {
    /// Backends and precisions at hand.
    fn arithmetics(&self) -> &[(BackendName, Precision)];
    /// Whether the memory holds a scene on a grid, else why not.
    ///
    /// # Errors
    /// In words.
    fn fits(&self, scene: &Scene, grid: Grid) -> Result<(), String>;
    /// A backend for a setup.
    ///
    /// # Errors
    /// In words.
    fn bench(&self, setup: &Setup) -> Result<Bench, String>;
}

/// Who watches a study.
pub trait Listener: Send {
    /// A run begins, which will take some seconds.
    fn begins(&mut self, words: &str, seconds: f64);
    /// It goes on; `false` ends the study.
    fn goes_on(&mut self, step: usize, iteration: usize, residual: f64) -> bool;
    /// Something to know.
    fn note(&mut self, text: &str);
    /// A row is done; all of them are in the report so far.
    ///
    /// # Errors
    /// What keeps it from being kept.
    fn row(&mut self, report: &Report) -> Result<(), AccuracyError>;
}
