//! A scene solved into a folder of results, as `tabor run` does it.
//!
//! [`run`] solves every step of a scene and writes its folder, which `docs/results.md` explains file by file;
//! [`RunOptions`] say how, and a [`RunObserver`] hears how far it is and may end it. A run that was ended is
//! resumed after its last finished step, to the same bits.
//!
//! ```
//! use tabor::{RunOptions, Scene};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let smaller = [("grid.points".to_owned(), "64".to_owned())]; // as --set on the command line
//! let scene = Scene::read("examples/scenes/rough.toml".as_ref(), &smaller)?;
//! let folder = tempfile::tempdir()?;
//! let end = tabor::run(scene, folder.path(), &mut ())?;
//! assert_eq!(end.rows.len(), 12);
//! assert!(folder.path().join("curve.csv").exists());
//! # Ok(())
//! # }
//! ```

mod earlier_files;
mod end;
mod in_memory;
pub(crate) mod memory_check;
mod observer;
mod on_ranks;
mod options;
mod run_directory;
mod run_recorder;
pub(crate) mod warnings;

pub use end::{RunEnd, RunError, RunStatus};
#[doc(hidden)]
pub use in_memory::solve_with;
pub use memory_check::MemoryError;
pub use observer::RunObserver;
pub use options::RunOptions;

use std::path::Path;
use std::sync::Arc;

use crate::backend::BackendError;
use crate::backend::cpu::with_threads;
use crate::backend::ranks::{Ranks, agree};
use crate::clock::Clock;
use crate::device::SelectedDevice;
use crate::output::Seconds;
use crate::scene::Scene;
use crate::study::{Checkpoint, Earlier, Setup, WalkEnd, WalkError, walk_on};
use crate::surface::Surface;
use on_ranks::{Ask, Following, LEADER, Leading, earlier_of_leader};
use run_directory::{ExistingRun, RunDirectory, fingerprint};
use run_recorder::RunRecorder;

/// Solves every step of a scene and writes `folder`, which is made where it is missing; one with files in it
/// is taken only if tabor wrote it for the same scene, and then its files are replaced.
///
/// A step that does not converge, and a run that the observer ends, are results: [`RunEnd::status`] tells.
///
/// # Errors
/// A surface that cannot be built, a run that the memory does not hold, a device that cannot be used or
/// fails, a folder that is not this scene's, files that cannot be written. Steps solved until then are
/// kept for [`RunOptions::resume`].
pub fn run(
    scene: Scene,
    folder: &Path,
    observer: &mut dyn RunObserver,
) -> Result<RunEnd, RunError> {
    run_with(scene, folder, &RunOptions::default(), observer)
}

/// As [`run`], with options.
///
/// # Errors
/// As [`run`].
pub fn run_with(
    scene: Scene,
    folder: &Path,
    options: &RunOptions,
    observer: &mut dyn RunObserver,
) -> Result<RunEnd, RunError> {
    run_on(scene, folder, options, None, observer)
}

/// As [`run_with`], over several processes: every one calls this with the same scene and folder, and holds a slab of
/// the rows. The first one writes the folder; the observers of the others hear only that the run starts. The results
/// have the same bits on any number of ranks, and as without any.
///
/// # Errors
/// As [`run`]; on all ranks but that on which it happened [`RunError::Rank`].
#[doc(hidden)]
pub fn run_on_ranks(
    scene: Scene,
    folder: &Path,
    options: &RunOptions,
    ranks: Arc<dyn Ranks>,
    observer: &mut dyn RunObserver,
) -> Result<RunEnd, RunError> {
    let several = Some(ranks).filter(|ranks| ranks.count() > 1);
    run_on(scene, folder, options, several, observer)
}

fn run_on(
    scene: Scene,
    folder: &Path,
    options: &RunOptions,
    ranks: Option<Arc<dyn Ranks>>,
    observer: &mut dyn RunObserver,
) -> Result<RunEnd, RunError> {
    let mut seconds = Seconds::default();
    seconds.add("scene", options.reading_seconds);
    let ready = prepared(scene, options, ranks.as_ref(), &mut seconds);
    let (setup, device) = match &ranks {
        Some(ranks) => agree(&**ranks, ready)?,
        None => ready?,
    };
    let existing = match (options.resume, options.overwrite) {
        (true, _) => ExistingRun::Resume,
        (false, true) => ExistingRun::Overwrite,
        (false, false) => ExistingRun::Refuse,
    };
    let work = Work {
        setup: &setup,
        folder,
        threads: options.threads,
        draws: options.draws(),
        ranks: ranks.as_deref(),
    };
    match work.walk(&device, existing, None, seconds.clone(), observer)? {
        Walked::Ended(end) => Ok(*end),
        // The device failed and another can continue: the solved steps are kept.
        Walked::Failed(error, fallback) => {
            let failed = format!("{error}; the processor continues after the last finished step");
            observer.warning(&failed);
            match work.walk(
                &fallback,
                ExistingRun::Resume,
                Some(failed),
                seconds,
                observer,
            )? {
                Walked::Ended(end) => Ok(*end),
                Walked::Failed(error, _) => Err(error.into()),
            }
        }
    }
}

/// The problem of a scene, and the device for it.
fn prepared(
    mut scene: Scene,
    options: &RunOptions,
    ranks: Option<&Arc<dyn Ranks>>,
    seconds: &mut Seconds,
) -> Result<(Setup, SelectedDevice), RunError> {
    if let Some(device) = options.device {
        scene.solver.backend = device.backend();
    }
    let clock = Clock::start();
    let check = |grid| match ranks {
        Some(ranks) => memory_check::check_on_ranks(&scene, grid, &**ranks),
        None => memory_check::check_grid(&scene, grid),
    };
    let count = ranks.map_or(1, |ranks| ranks.count());
    memory_check::check_scene_by(&scene, count, check)?;
    let surface = Surface::on_ranks(&scene, ranks.cloned())?;
    // Of a grid that a height file carries.
    check(surface.grid)?;
    let setup = Setup::on_ranks(scene, surface, ranks.cloned());
    seconds.add("surface", clock.seconds());
    let clock = Clock::start();
    let device = match ranks {
        Some(ranks) => SelectedDevice::on_ranks(&setup, Arc::clone(ranks))?,
        None => {
            let hears_drivers = options.device.is_some_and(|device| device.hears_drivers());
            SelectedDevice::new(&setup, hears_drivers)?
        }
    };
    seconds.add("device", clock.seconds());
    Ok((setup, device))
}

/// Everything a path is solved with but its device.
struct Work<'a> {
    setup: &'a Setup,
    folder: &'a Path,
    threads: Option<usize>,
    draws: bool,
    /// The processes that share the contact, if there are several.
    ranks: Option<&'a dyn Ranks>,
}

/// How a path ended on a device.
enum Walked {
    Ended(Box<RunEnd>),
    /// The device failed, and another can continue.
    Failed(BackendError, SelectedDevice),
}

impl Work<'_> {
    /// Walks the path on a device and writes its folder, with the warning of how the device before it `failed`.
    fn walk(
        &self,
        device: &SelectedDevice,
        existing: ExistingRun,
        failed: Option<String>,
        mut seconds: Seconds,
        observer: &mut dyn RunObserver,
    ) -> Result<Walked, RunError> {
        let setup = self.setup;
        observer.starts(&device.words());
        let scene = fingerprint(setup);
        if let Some(ranks) = self.ranks.filter(|ranks| ranks.rank() != LEADER) {
            let end = self.follow(device, ranks)?;
            let summary = end::summary(setup, device, &end, seconds, Vec::new());
            return Ok(Walked::Ended(Box::new(RunEnd::new(setup, end, summary))));
        }
        // Whether there are threads: from here on an end of this rank alone would keep the others waiting.
        let threaded = |directory| Ok(with_threads(self.threads, || directory)?);
        let opened = RunDirectory::open(
            self.folder,
            setup,
            device,
            existing,
            self.draws,
            scene.clone(),
        );
        let mut directory = match self.ranks {
            Some(ranks) => agree(ranks, opened.map_err(RunError::from).and_then(threaded))?,
            None => opened?,
        };
        directory.warnings.extend(failed);
        for remark in device.remark.iter().chain(&directory.remarks) {
            observer.note(remark);
        }
        for warning in setup.warnings.iter().chain(&directory.lost) {
            observer.warning(warning);
        }
        let mut earlier = directory.earlier.clone();
        if let Some(ranks) = self.ranks {
            earlier = earlier_of_leader(ranks, setup, &earlier, directory.state.take())?;
        }
        seconds.add("solve", earlier.rows.iter().map(|row| row.seconds).sum());
        let finished = earlier.rows.len();
        let steps = setup.scene.loading.path.len().max(finished);
        observer.begins(steps, finished, setup.scene.solver.tolerance);
        let mut recorder = RunRecorder::new(
            setup, device, directory, seconds, self.draws, scene, observer,
        );
        let make_backend = || device.backend();
        let walked = with_threads(self.threads, || match self.ranks {
            Some(ranks) => {
                let mut leading = Leading {
                    ranks,
                    observer: &mut recorder,
                };
                walk_on(setup, &make_backend, &mut leading, earlier)
            }
            None => walk_on(setup, &make_backend, &mut recorder, earlier),
        })?;
        let (end, failure) = match walked {
            Ok(end) => (end, None),
            Err(WalkError::Backend(error)) if let Some(fallback) = device.fallback(setup) => {
                return Ok(Walked::Failed(error, fallback));
            }
            // The solved steps stay: they are summed up like any other end.
            Err(WalkError::Backend(error)) => (recorder.end_so_far(), Some(error)),
            Err(WalkError::Observer(error)) => {
                recorder.report_kept();
                return Err(error.into());
            }
        };
        let written = recorder.finish(&end, |seconds, warnings| {
            end::summary(setup, device, &end, seconds, warnings)
        });
        if let (Some(ranks), None) = (self.ranks, &failure) {
            Ask::GoOn(written.is_ok()).send(ranks);
        }
        if failure.is_some() || end.interrupted || written.is_err() {
            recorder.report_kept();
        }
        match (failure, written) {
            (Some(error), _) => Err(error.into()),
            (None, written) => Ok(Walked::Ended(Box::new(RunEnd::new(setup, end, written?)))),
        }
    }
    /// Walks the path with the rank that leads, and writes nothing.
    fn follow(&self, device: &SelectedDevice, ranks: &dyn Ranks) -> Result<WalkEnd, RunError> {
        agree(
            ranks,
            with_threads(self.threads, || ()).map_err(RunError::from),
        )?;
        let earlier = earlier_of_leader(ranks, self.setup, &Earlier::default(), None)?;
        let make_backend = || device.backend();
        let mut following = Following::new(ranks, self.setup);
        let walked = with_threads(self.threads, || {
            walk_on(self.setup, &make_backend, &mut following, earlier)
        })?;
        let end = walked.map_err(|error| match error {
            WalkError::Backend(error) => RunError::from(error),
            WalkError::Observer(error) => error.into(),
        })?;
        // The leader writes what is left.
        following.kept(&Checkpoint::default())?;
        Ok(end)
    }
}
