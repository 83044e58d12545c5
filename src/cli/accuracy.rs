//! `tabor accuracy`: error against seconds.

use std::io::{IsTerminal, stderr};
use std::path::PathBuf;
use std::sync::OnceLock;
use std::time::Instant;

use clap::Args;
use indicatif::ProgressBar;

use super::interrupts::Interrupts;
use super::patience::Patience;
use super::progress::bar;
use super::quantity::positive;
use super::{Failure, SceneArguments, folder_or_default, note, say, warn};
use crate::accuracy::{
    AccuracyError, BackendProvider, Listener, ProvidedBackend, Report, Study, duration,
    expect_place, picture, screen, write_csv,
};
use crate::backend::cpu::with_threads;
use crate::device::{SelectedDevice, has_adapter_for};
use crate::grid::Grid;
use crate::output::FolderLock;
use crate::run::memory_check;
use crate::scene::{BackendName, Precision, Scene};
use crate::study::Setup;
use crate::units::Dimension;

/// The rows of a study.
const TABLE: &str = "accuracy.csv";

#[derive(Debug, Args)]
pub(super) struct AccuracyArguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// How long it may take, as in "90 s"; what there is no time for is left out and listed
    #[arg(long, value_name = "TIME", default_value = "5 min", value_parser = time)]
    budget: f64,
    /// Folder for accuracy.csv and accuracy.png [default: the scene's name with _accuracy]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// No progress and no table; warnings and errors are still said
    #[arg(long)]
    quiet: bool,
    /// Let graphics drivers say what they say at their start
    #[arg(long)]
    verbose: bool,
}

/// A budget: a time with a unit, or in seconds.
fn time(text: &str) -> Result<f64, String> {
    let seconds = positive(text, Dimension::Time)?;
    if seconds < 1e9 {
        Ok(seconds)
    } else {
        Err("give a time below 1e9 s, such as \"5 min\"".to_owned())
    }
}

/// Runs the study and writes `accuracy.csv` and `accuracy.png`.
pub(super) fn accuracy(arguments: &AccuracyArguments) -> Result<(), Failure> {
    // On a terminal a bar says so.
    let _patience = (!arguments.quiet && !stderr().is_terminal())
        .then(|| Patience::new("--budget says how long it may take"));
    let scene = arguments.scene.read()?;
    memory_check::check_scene(&scene)?;
    let folder = folder_or_default(arguments.out.as_deref(), &arguments.scene.path, "_accuracy");
    if let Some(adhesion) = &scene.adhesion
        && adhesion.treatment == crate::scene::Treatment::Dmt
    {
        note("adhesion.treatment = \"dmt\" is judged by the full law, as one of the settings");
    }
    let shop = Shop {
        arguments,
        scene: &scene,
        arithmetics: OnceLock::new(),
    };
    let outputs = [TABLE, "accuracy.png", "accuracy.svg"].map(|name| folder.join(name));
    arguments.scene.expect_apart(&scene, outputs)?;
    let study = match Study::new(&scene, &shop, arguments.budget) {
        Err(AccuracyError::Surface(error)) => {
            return Err(arguments.scene.surface_failure(error));
        }
        study => study?,
    };
    // Each row is written with all rows before it: those of a second study in the folder would be lost.
    expect_place(&folder.join(TABLE)).map_err(AccuracyError::from)?;
    let lock = FolderLock::take(&folder.join(FolderLock::HIDDEN), &folder)?;
    if let Some(warning) = lock.warning() {
        warn(warning);
    }
    let interrupts = Interrupts::watch();
    interrupts.keep(format!(
        "note: the settings done are kept in {}",
        folder.display()
    ));
    let mut keeper = Keeper {
        folder: folder.clone(),
        bar: bar(
            "{bar:24} {pos}/{len} s  {wide_msg}",
            arguments.budget.ceil() as u64,
            arguments.quiet,
        ),
        began: Instant::now(),
        running: String::new(),
        said: Vec::new(),
        interrupts,
    };
    let threads = arguments.threads.map(usize::from);
    let report = with_threads(threads, || study.run(&mut keeper))??;
    drop(keeper);
    picture(&report).write(&folder.join("accuracy.png"))?;
    if !arguments.quiet {
        for line in screen(&report).lines() {
            say(line);
        }
    }
    if report.interrupted {
        return Err(Failure::InterruptedStudy {
            rows: report.rows.len(),
            folder,
        });
    }
    Ok(())
}

/// The backends and precisions at hand here.
struct Shop<'a> {
    arguments: &'a AccuracyArguments,
    scene: &'a Scene,
    /// Looked for when the study first wants them.
    arithmetics: OnceLock<Vec<(BackendName, Precision)>>,
}

impl Shop<'_> {
    /// Asks the scene's own reader which of them are in this version, and the machine for an adapter
    /// where the scene leaves it open and one can take the grid.
    fn found(&self) -> Vec<(BackendName, Precision)> {
        let arguments = self.arguments;
        let mut backends = vec![BackendName::Cpu];
        let asked = self.scene.solver.backend;
        if asked != BackendName::Cpu && has_adapter_for(self.scene, arguments.verbose) {
            backends.push(BackendName::Gpu);
        }
        let precisions = [Precision::Double, Precision::Single, Precision::Mixed];
        let is_here = |backend: BackendName, precision: Precision| {
            let word = |name: &str| format!("\"{name}\"");
            let mut set = arguments.scene.set.clone();
            set.extend([
                ("solver.backend".to_owned(), word(backend.name())),
                ("solver.precision".to_owned(), word(precision.name())),
                (
                    "solver.tolerance".to_owned(),
                    Precision::SINGLE_FLOOR.to_string(),
                ),
            ]);
            Scene::read(&arguments.scene.path, &set).is_ok()
        };
        backends
            .into_iter()
            .flat_map(|backend| precisions.map(|precision| (backend, precision)))
            .filter(|(backend, precision)| is_here(*backend, *precision))
            .collect()
    }
}

impl BackendProvider for Shop<'_> {
    fn arithmetics(&self) -> &[(BackendName, Precision)] {
        self.arithmetics.get_or_init(|| self.found())
    }

    fn fits(&self, scene: &Scene, grid: Grid) -> Result<(), String> {
        memory_check::check_grid(scene, grid).map_err(|error| Failure::from(error).to_string())
    }

    fn provide(&self, setup: &Setup) -> Result<ProvidedBackend, String> {
        let device = SelectedDevice::new(setup, self.arguments.verbose)
            .map_err(|error| Failure::from(error).to_string())?;
        Ok(ProvidedBackend {
            remark: device.remark.clone(),
            make: Box::new(move || device.backend()),
        })
    }
}

/// Keeps the rows, shows how far the study is, and ends it where the user wants.
struct Keeper {
    folder: PathBuf,
    bar: Option<ProgressBar>,
    began: Instant,
    running: String,
    said: Vec<String>,
    interrupts: Interrupts,
}

impl Listener for Keeper {
    fn begins(&mut self, words: &str, seconds: f64) {
        self.running = format!("{words}, about {}", duration(seconds));
    }

    fn iteration(&mut self, step: usize, iteration: usize, residual: f64) -> bool {
        if let Some(bar) = &self.bar {
            bar.set_position(self.began.elapsed().as_secs());
            bar.set_message(format!(
                "{}: step {step}, iteration {iteration}, residual {residual:.1e}",
                self.running
            ));
        }
        !self.interrupts.raised()
    }

    fn note(&mut self, text: &str) {
        // Once is enough: each run on the same adapter has the same remark.
        if self.said.iter().any(|said| said == text) {
            return;
        }
        self.said.push(text.to_owned());
        match &self.bar {
            Some(bar) => bar.suspend(|| note(text)),
            None => note(text),
        }
    }

    fn row(&mut self, report: &Report) -> Result<(), AccuracyError> {
        Ok(write_csv(&self.folder.join(TABLE), report)?)
    }
}

impl Drop for Keeper {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_budget_that_cannot_be_read_is_told_why() {
        assert_eq!(time("5 min"), Ok(300.0));
        assert_eq!(time("90"), Ok(90.0));
        for (text, words) in [
            ("1 h", "\"h\" is not a unit"),
            ("10 m", "is a length"),
            ("0", "greater than zero"),
            ("1e12", "below 1e9 s"),
        ] {
            let said = time(text).expect_err(text);
            assert!(said.contains(words), "{text}: {said}");
        }
    }
}
