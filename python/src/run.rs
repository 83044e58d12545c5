//! A scene solved into its folder, and the program `tabor` itself.

use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};

use pyo3::prelude::*;
use pyo3::types::PyList;
use tabor::backend::cpu::with_threads;
use tabor::{RunObserver, RunOptions, RunStatus, StepRow};

use crate::arrays::Lent;
use crate::errors;
use crate::scene::LoadedScene;
use crate::waiting::{Talk, wait_and_join};

/// Hears a run on the solver's thread.
struct Hearer {
    talk: Arc<Talk>,
    warned: Sender<String>,
}

impl RunObserver for Hearer {
    fn warning(&mut self, text: &str) {
        // Nobody may be waiting any more.
        let _ = self.warned.send(text.to_owned());
    }

    fn iteration(&mut self, _step: usize, iteration: usize, residual: f64) -> bool {
        self.talk.iteration(iteration, residual)
    }

    fn step(&mut self, row: &StepRow) {
        self.talk.finished(row.step);
    }
}

/// Runs the program `tabor` on `words`, its own name first, and returns its exit code. A wrong call and a request for
/// help end the process.
#[pyfunction]
pub fn command_line(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| tabor::command_line_with(words))
}

/// Solves every step of a scene into a folder. Returns why the run is not finished, if so. Warnings are added to `said`,
/// also where it raises.
#[pyfunction]
#[pyo3(signature = (scene, folder, said, resume=false, overwrite=true, images=true, threads=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "Python names each of them")]
pub fn run(
    py: Python<'_>,
    scene: &LoadedScene,
    folder: PathBuf,
    said: &Bound<'_, PyList>,
    resume: bool,
    overwrite: bool,
    images: bool,
    threads: Option<usize>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Option<String>> {
    let mut options = RunOptions::new()
        .resume(resume)
        .overwrite(overwrite)
        .images(images);
    if let Some(threads) = threads {
        options = options.threads(threads);
    }
    let talk = Arc::new(Talk::default());
    let (warned, heard) = channel();
    let mut hearer = Hearer {
        talk: Arc::clone(&talk),
        warned,
    };
    Lent::check(py, &scene.lent)?;
    let (teller, scene) = (scene.teller(), scene.scene.clone());
    let end = wait_and_join(py, &talk, progress, move || {
        // The pool that all share is without threads in a fork of this process, and not all of a run is in the pool that it makes.
        with_threads(threads, || {
            tabor::run_with(scene, &folder, &options, &mut hearer)
        })?
    });
    for words in heard.try_iter() {
        said.append(words)?;
    }
    let end = end?.map_err(|error| errors::of_run(py, teller, &error))?;
    Ok(match end.status {
        RunStatus::Finished => None,
        early => Some(early.to_string()),
    })
}
