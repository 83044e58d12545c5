//! How far a run has come, on standard error and only to a terminal.

use std::io::{IsTerminal, stderr};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A progress line, or nothing where nobody watches.
#[derive(Debug)]
pub struct Progress {
    bar: Option<ProgressBar>,
}

impl Progress {
    /// A line for `steps` steps; silent with `quiet` or where standard error is not a terminal.
    pub fn new(steps: usize, quiet: bool) -> Progress {
        if quiet || !stderr().is_terminal() {
            return Progress { bar: None };
        }
        let style =
            ProgressStyle::with_template("{bar:24} step {pos}/{len}  {msg}  {elapsed_precise}")
                .expect("the template is fixed and valid");
        let bar = ProgressBar::with_draw_target(
            Some(steps as u64),
            ProgressDrawTarget::stderr_with_hz(10),
        )
        .with_style(style);
        bar.enable_steady_tick(Duration::from_millis(200));
        Progress { bar: Some(bar) }
    }

    /// Shows the solver at work: the iteration it has reached and its residual.
    pub fn iteration(&self, iteration: usize, residual: f64) {
        if let Some(bar) = &self.bar {
            bar.set_message(format!("iteration {iteration}  residual {residual:.1e}"));
        }
    }

    /// Says that `finished` steps are done.
    pub fn finished_steps(&self, finished: usize) {
        if let Some(bar) = &self.bar {
            bar.set_position(finished as u64);
        }
    }

    /// Prints a line to standard error, always, above the progress line where there is one.
    pub fn say(&self, line: &str) {
        match &self.bar {
            Some(bar) => bar.suspend(|| eprintln!("{line}")),
            None => eprintln!("{line}"),
        }
    }
}

impl Drop for Progress {
    /// Takes the line away, so that an error message does not land beside it.
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
