//! `tabor run`: the main job.

use std::sync::Arc;

use super::interrupts::Interrupts;
use super::launcher::Launched;
use super::progress::{Progress, time};
use super::{Failure, RunArguments, folder_or_default, note, say, table, warn};
use crate::backend::ranks::agree;
use crate::clock::Clock;
use crate::device::Device;
use crate::output::sentence;
use crate::run::{RunEnd, RunError, RunObserver, RunOptions, RunStatus, run_on_ranks, run_with};
use crate::scene::Precision;
use crate::study::{StepRow, Unreachable};

/// Solves a scene and writes its folder, with the other processes of a launcher if there are some.
pub(super) fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let launched = Launched::start()?;
    let done = run_launched(arguments, &launched);
    if launched.speaks() {
        return done;
    }
    match done {
        // The rank that failed says why, and ends with its own status.
        Ok(()) | Err(Failure::Rank(_)) => Ok(()),
        Err(own) => Err(own),
    }
}

fn run_launched(arguments: &RunArguments, launched: &Launched) -> Result<(), Failure> {
    let clock = Clock::start();
    let scene = match launched.ranks() {
        Some(ranks) => agree(&**ranks, arguments.read())?,
        None => arguments.read()?,
    };
    let max_iterations = scene.solver.max_iterations;
    let device = Device::from(scene.solver.backend);
    let mut options = RunOptions::new()
        .resume(arguments.resume)
        .device(if arguments.verbose {
            device.hear_drivers()
        } else {
            device
        })
        .reading_seconds(clock.seconds());
    if let Some(threads) = arguments.threads {
        options = options.threads(threads.into());
    }
    let folder = folder_or_default(arguments.out.as_deref(), &arguments.scene.path, "");
    let mut terminal = Terminal {
        quiet: arguments.quiet || !launched.speaks(),
        progress: None,
        interrupts: None,
    };
    let ended = match launched.ranks() {
        Some(ranks) => {
            let ranks = Arc::clone(ranks);
            run_on_ranks(scene, &folder, &options, ranks, &mut terminal)
        }
        None => run_with(scene, &folder, &options, &mut terminal),
    };
    drop(terminal);
    let end = ended.map_err(|error| match error {
        RunError::Surface(error) => arguments.scene.surface_failure(error),
        other => other.into(),
    })?;
    if !launched.speaks() {
        return Ok(());
    }
    if !arguments.quiet {
        table::print(&end.rows);
        say(&format!(
            "{} Solved in {}; the report is {}",
            sentence(&end.summary, &end.rows),
            time(clock.seconds()),
            folder.join("report.html").display()
        ));
    }
    judge(&end, max_iterations)
}

/// Shows a run on the terminal, and ends it where the user wants.
struct Terminal {
    quiet: bool,
    /// From the first step on.
    progress: Option<Progress>,
    /// From when the device is ready.
    interrupts: Option<Interrupts>,
}

impl RunObserver for Terminal {
    fn starts(&mut self, _device: &str) {
        self.interrupts.get_or_insert_with(Interrupts::watch);
    }

    fn note(&mut self, text: &str) {
        note(text);
    }

    fn warning(&mut self, text: &str) {
        match &self.progress {
            Some(progress) => progress.say(&format!("warning: {text}")),
            None => warn(text),
        }
    }

    fn begins(&mut self, steps: usize, finished: usize, tolerance: f64) {
        // The line of a device that has failed goes first.
        self.progress = None;
        self.progress = Some(Progress::new(steps, finished, tolerance, self.quiet));
    }

    fn iteration(&mut self, _step: usize, iteration: usize, residual: f64) -> bool {
        if let Some(progress) = &self.progress {
            progress.iteration(iteration, residual);
        }
        !self.interrupts.as_ref().is_some_and(Interrupts::raised)
    }

    fn search(&mut self, _step: usize, words: &str) {
        if let Some(progress) = &self.progress {
            progress.search(words.to_owned());
        }
    }

    fn step(&mut self, row: &StepRow) {
        if let Some(progress) = &self.progress {
            progress.finished_steps(row.step);
        }
    }

    fn kept(&mut self, words: &str) {
        if let Some(interrupts) = &self.interrupts {
            interrupts.keep(words.to_owned());
        }
    }

    fn ended_early(&mut self, kept: &str) {
        say(kept);
    }
}

/// What is to be done where a step did not converge: it may have stalled before its iterations ran out, and have been solved in
/// double precision already.
fn remedy(unreachable: Option<Unreachable>, stalled: bool, is_double: bool) -> String {
    let remedy = match unreachable {
        None if stalled && is_double => {
            "the iteration stalls there: name smaller steps, or ask for a larger tolerance"
        }
        None if stalled => {
            "the iteration stalls there: name smaller steps, or ask for precision = \"double\" or a larger tolerance"
        }
        None => "allow more max_iterations, or take smaller steps",
        Some(Unreachable::Unmeasured) => {
            "the contact is solved, and its [conductance] or [leakage] is not: allow more max_iterations"
        }
        Some(why) => return format!("{why}: end the path earlier"),
    };
    remedy.to_owned()
}

/// The end of a run as its exit status.
fn judge(end: &RunEnd, max_iterations: usize) -> Result<(), Failure> {
    let is_double = end.summary.precision == Precision::Double.name();
    match end.status {
        RunStatus::Finished => Ok(()),
        RunStatus::Interrupted { finished, steps } => Err(Failure::Interrupted { finished, steps }),
        RunStatus::NotConverged {
            step,
            residual,
            iterations,
            tolerance,
            unreachable,
        } => Err(Failure::NotConverged {
            step,
            residual,
            iterations,
            tolerance,
            remedy: remedy(unreachable, iterations < max_iterations, is_double),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stall in double precision is not sent to double precision.
    #[test]
    fn the_remedy_of_a_stall_is_another_precision_only_where_there_is_one() {
        let double = |is_double| remedy(None, true, is_double).contains("double");
        assert!(double(false) && !double(true));
        assert!(remedy(None, false, true).contains("max_iterations"));
    }
}
