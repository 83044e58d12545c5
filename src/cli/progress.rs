//! Progress of a run on standard error, only on a terminal.

use std::cell::{Cell, RefCell};
use std::io::{IsTerminal, Write, stderr};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::output::visible;

/// A bar of so many parts; none with `quiet` or if standard error is not a terminal.
pub(super) fn bar(template: &str, length: u64, quiet: bool) -> Option<ProgressBar> {
    if quiet || !stderr().is_terminal() {
        return None;
    }
    let style = ProgressStyle::with_template(template).ok()?;
    let target = ProgressDrawTarget::stderr_with_hz(10);
    let bar = ProgressBar::with_draw_target(Some(length), target).with_style(style);
    bar.enable_steady_tick(Duration::from_millis(200));
    Some(bar)
}

/// A progress line; silent if standard error is not a terminal.
#[derive(Debug)]
pub(super) struct Progress {
    line: Option<Line>,
}

#[derive(Debug)]
struct Line {
    bar: ProgressBar,
    started: Instant,
    /// Total steps, steps done before this run, and steps done now.
    steps: usize,
    earlier: usize,
    finished: Cell<usize>,
    tolerance: f64,
    /// Residual of the first iteration of this step.
    first: Cell<f64>,
    /// The current search, followed by two spaces.
    search: RefCell<String>,
}

impl Progress {
    /// A line for `steps` steps of which `finished` are done, each solved to `tolerance`; silent
    /// with `quiet` or if standard error is not a terminal.
    pub fn new(steps: usize, finished: usize, tolerance: f64, quiet: bool) -> Progress {
        let template = "{bar:24} step {prefix}/{len}  {wide_msg}";
        let Some(bar) = bar(template, steps as u64, quiet) else {
            return Progress { line: None };
        };
        bar.set_position(finished as u64);
        bar.set_prefix((finished + 1).min(steps).to_string());
        let line = Line {
            bar,
            started: Instant::now(),
            steps,
            earlier: finished,
            finished: Cell::new(finished),
            tolerance,
            first: Cell::new(f64::NAN),
            search: RefCell::default(),
        };
        Progress { line: Some(line) }
    }

    /// Shows the current iteration and its residual.
    pub fn iteration(&self, iteration: usize, residual: f64) {
        let Some(line) = &self.line else { return };
        if !line.first.get().is_finite() {
            line.first.set(residual);
        }
        let share = share_of_step(line.first.get(), residual, line.tolerance);
        let done = (line.finished.get() - line.earlier) as f64 + share;
        let left = (line.steps - line.earlier) as f64 - done;
        line.bar.set_message(format!(
            "{}iteration {iteration}  residual {residual:.1e}  {}",
            line.search.borrow(),
            time_left(line.started.elapsed().as_secs_f64(), done, left)
        ));
    }

    /// Shows a search that this step needs in addition to its load.
    pub fn search(&self, words: String) {
        if let Some(line) = &self.line {
            line.first.set(f64::NAN);
            line.search.replace(words + "  ");
        }
    }

    /// Shows that `finished` steps are done.
    pub fn finished_steps(&self, finished: usize) {
        if let Some(line) = &self.line {
            line.finished.set(finished);
            line.first.set(f64::NAN);
            line.search.replace(String::new());
            line.bar.set_position(finished as u64);
            let next = (finished + 1).min(line.steps);
            line.bar.set_prefix(next.to_string());
        }
    }

    /// Always prints a line to standard error, above the progress line if there is one.
    /// Continuation lines are indented.
    pub fn say(&self, text: &str) {
        let text = visible(text).replace('\n', "\n  ");
        // If standard error is closed nobody can be told.
        let write = || {
            let _ = writeln!(stderr(), "{text}");
        };
        match &self.line {
            Some(line) => line.bar.suspend(write),
            None => write(),
        }
    }
}

/// Completed share of a step, by the decades from its first residual to the tolerance.
fn share_of_step(first: f64, residual: f64, tolerance: f64) -> f64 {
    let share = (first / residual).ln() / (first / tolerance).ln();
    if share.is_finite() {
        share.clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Remaining time in words, estimated from the seconds that `done` steps took.
fn time_left(seconds: f64, done: f64, left: f64) -> String {
    let estimate = seconds * left / done;
    if !estimate.is_finite() || done <= 0.0 || seconds < 1.0 {
        return String::new();
    }
    format!("about {} left", time(estimate))
}

/// A time in words.
pub(super) fn time(seconds: f64) -> String {
    let whole = seconds.max(0.0).round() as u64;
    match whole {
        0..60 => format!("{whole} s"),
        60..3600 => format!("{} min {:02} s", whole / 60, whole % 60),
        _ => format!("{} h {:02} min", whole / 3600, whole % 3600 / 60),
    }
}

impl Drop for Progress {
    /// Removes the line, so that an error message starts on a line of its own.
    fn drop(&mut self) {
        if let Some(line) = &self.line {
            line.bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_done_by_decades() {
        assert!((share_of_step(1e-1, 1e-3, 1e-6) - 0.4).abs() < 1e-12);
        assert_eq!(share_of_step(1e-1, 1e-9, 1e-6), 1.0);
        assert_eq!(share_of_step(1e-1, 1.0, 1e-6), 0.0);
        for odd in [f64::NAN, f64::INFINITY, 0.0] {
            let share = share_of_step(odd, 1e-3, 1e-6);
            assert!((0.0..=1.0).contains(&share));
        }
    }

    #[test]
    fn the_time_left_follows_the_time_taken() {
        assert_eq!(time_left(10.0, 2.0, 3.0), "about 15 s left");
        assert_eq!(time_left(100.0, 1.0, 3.0), "about 5 min 00 s left");
        assert_eq!(time_left(3600.0, 0.5, 1.0), "about 2 h 00 min left");
        // Nothing is known yet.
        assert_eq!(time_left(0.3, 0.1, 4.0), "");
        assert_eq!(time_left(5.0, 0.0, 4.0), "");
    }
}
