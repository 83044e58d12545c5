//! A scene solved without a folder: rows and summary, nothing on the disk.

use std::convert::Infallible;

use super::end::{self, RunEnd, RunError};
use super::memory_check;
use super::warnings::warnings_at_end;
use super::{RunObserver, RunOptions};
use crate::backend::BackendError;
use crate::backend::cpu::{in_pool, with_threads};
use crate::clock::Clock;
use crate::device::SelectedDevice;
use crate::kernel::Scalars;
use crate::output::Seconds;
use crate::scene::Scene;
use crate::study::{FinishedStep, Observer, Setup, WalkEnd, WalkError, step_warnings, walk};
use crate::surface::Surface;

/// Solves every step of a scene as [`run_with`](super::run_with) does, and writes nothing. Without a number of threads
/// in the options it takes those of its caller, so that many scenes share one pool.
///
/// # Errors
/// A surface that cannot be built, a run that the memory does not hold, a device that cannot be used or fails.
pub fn solve_with(
    mut scene: Scene,
    options: &RunOptions,
    observer: &mut dyn RunObserver,
) -> Result<RunEnd, RunError> {
    if let Some(device) = options.device {
        scene.solver.backend = device.backend();
    }
    let mut seconds = Seconds::default();
    let clock = Clock::start();
    memory_check::check_scene(&scene)?;
    let surface = Surface::build(&scene)?;
    memory_check::check_grid(&scene, surface.grid)?;
    let setup = Setup::new(scene, surface);
    seconds.add("surface", clock.seconds());
    let device = SelectedDevice::new(&setup, false)?;
    observer.starts(&device.words());
    for warning in &setup.warnings {
        observer.warning(warning);
    }
    let clock = Clock::start();
    let mut warnings = setup.warnings.clone();
    let mut walk = |device: &_, observer: &mut dyn RunObserver| {
        walk_on_device(&setup, device, options, observer, &mut warnings)
    };
    let (end, device) = match walk(&device, observer) {
        Ok(end) => (end, device),
        Err(error) => {
            let Some(fallback) = device.fallback(&setup) else {
                return Err(error.into());
            };
            let failed = format!("{error}; the processor begins again");
            observer.warning(&failed);
            let end = walk(&fallback, observer)?;
            warnings.push(failed);
            (end, fallback)
        }
    };
    seconds.add("solve", clock.seconds());
    warnings.extend(warnings_at_end(&setup, &device, &end));
    let summary = end::summary(&setup, &device, &end, seconds, warnings);
    Ok(RunEnd::new(&setup, end, summary))
}

/// Walks the whole path on a device, and adds what its steps warn of.
fn walk_on_device(
    setup: &Setup,
    device: &SelectedDevice,
    options: &RunOptions,
    observer: &mut dyn RunObserver,
    warnings: &mut Vec<String>,
) -> Result<WalkEnd, BackendError> {
    let steps = setup.scene.loading.path.len();
    observer.begins(steps, 0, setup.scene.solver.tolerance);
    let mut steps = Steps {
        setup,
        observer,
        warnings,
    };
    let make_backend = || device.backend();
    let mut work = || walk(setup, &make_backend, &mut steps);
    let walked = match options.threads {
        Some(threads) => with_threads(Some(threads), &mut work)?,
        None => in_pool(&mut work),
    };
    walked.map_err(|error| match error {
        WalkError::Backend(error) => error,
        WalkError::Observer(never) => match never {},
    })
}

/// Passes steps and iterations on.
struct Steps<'a> {
    setup: &'a Setup,
    observer: &'a mut dyn RunObserver,
    /// Warnings of the run.
    warnings: &'a mut Vec<String>,
}

impl Observer for Steps<'_> {
    type Error = Infallible;

    fn step(&mut self, step: FinishedStep) -> Result<(), Infallible> {
        for text in step_warnings(self.setup, &step, self.warnings) {
            self.observer.warning(&text);
            self.warnings.push(text);
        }
        self.observer.step(step.row);
        Ok(())
    }

    fn iteration(&mut self, step: usize, scalars: &Scalars) -> bool {
        self.observer
            .iteration(step, scalars.iterations as usize, scalars.residual)
    }
}
