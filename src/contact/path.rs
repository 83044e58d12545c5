//! Loads solved one after another.

use std::sync::{Mutex, PoisonError};

use super::builder::{Contact, Watcher, append};
use super::control::{Control, Load};
use super::error::ContactError;
use super::solution::Solution;
use crate::backend::cpu::{Threads, keep_memory};
use crate::device::SelectedDevice;
use crate::kernel::Scalars;
use crate::run::memory_check;
use crate::run::warnings::warnings_at_end;
use crate::scene::{LoadingScene, Scene};
use crate::study::{
    Checkpoint, Earlier, Evaluation, FinishedStep, Jump, Observer, Planned, Setup, Walk, WalkError,
    step_warnings,
};
use crate::surface::Surface;

/// Solutions of loads, one after another, each from the state of the one before; see [`Contact::path`].
pub struct Path<I> {
    contact: Contact,
    loads: I,
    /// From the first load on.
    course: Option<Course>,
    /// Whether it goes on behind its loads.
    until_apart: bool,
    ended: bool,
    /// Whether what the whole path warns of has been said.
    concluded: bool,
}

/// A path on its way.
struct Course {
    setup: Setup,
    device: SelectedDevice,
    threads: Threads,
    /// Its solver and the steps so far. Nobody waits at the lock: with it threads may share a path, though a
    /// backend no more than moves from one to another.
    walk: Mutex<Walk>,
    /// The last finished load, where another device may have to go on from it.
    finished: Option<Earlier>,
    /// The loads that were given, once there are further ones.
    given: Option<LoadingScene>,
    remarks: Vec<String>,
}

impl<I> Path<I> {
    pub(super) fn new(contact: Contact, loads: I) -> Self {
        Path {
            contact,
            loads,
            course: None,
            until_apart: false,
            ended: false,
            concluded: false,
        }
    }

    /// Goes on behind the loads, outwards, in steps that become finer, until the surfaces are apart: the steps of a
    /// scene with `until = "apart"`.
    pub fn until_apart(mut self) -> Self {
        self.until_apart = true;
        self
    }

    /// Warnings of the contact, one sentence each, from the first load on: waves that the grid
    /// does not resolve, a cohesive zone of too few pixels, and on which device it is solved. Once the path has given
    /// `None`, also those of a whole path, such as a pull-off that it does not show.
    pub fn warnings(&self) -> Vec<String> {
        match &self.course {
            None => Vec::new(),
            Some(course) => [course.setup.warnings.as_slice(), &course.remarks].concat(),
        }
    }
}

impl<I> Iterator for Path<I>
where
    I: Iterator,
    I::Item: Into<Load>,
{
    type Item = Result<Solution, ContactError>;

    fn next(&mut self) -> Option<Self::Item> {
        let Some(load) = self.next_load() else {
            self.conclude();
            return None;
        };
        let solved = self.solve(load);
        self.ended = !solved.as_ref().is_ok_and(|solution| solution.converged);
        Some(solved)
    }
}

impl<I> Path<I>
where
    I: Iterator,
    I::Item: Into<Load>,
{
    /// The next of the loads, or the next behind them; `None` where the path has ended.
    fn next_load(&mut self) -> Option<Load> {
        if self.ended {
            return None;
        }
        match self.loads.next() {
            Some(load) => Some(load.into()),
            None if self.until_apart => self.course.as_mut()?.load_behind(),
            None => None,
        }
    }
}

impl<I> Path<I> {
    /// Says once what the whole path warns of: the end of its loads does it.
    #[doc(hidden)]
    pub fn conclude(&mut self) {
        if let Some(course) = self.course.as_mut().filter(|_| !self.concluded) {
            let end = lock(&mut course.walk).end(&course.setup);
            let found = warnings_at_end(&course.setup, &course.device, &end);
            course.remarks.extend(found);
            self.concluded = true;
        }
    }

    fn solve(&mut self, load: Load) -> Result<Solution, ContactError> {
        let contact = &self.contact;
        let course = match &mut self.course {
            Some(course) => {
                append(&mut course.setup.scene, load)?;
                check(&course.setup.scene)?;
                course
            }
            // The surface is built by the same threads as the loads are solved.
            None => {
                // Each solution is handed over in fields of its own.
                keep_memory();
                let threads = Threads::new(contact.threads)?;
                let (setup, device) = threads.run(|| begin(contact, load))?;
                self.course.insert(Course::new(setup, device, threads))
            }
        };
        course.step(contact)
    }
}

/// Makes everything ready for the first load.
fn begin(contact: &Contact, load: Load) -> Result<(Setup, SelectedDevice), ContactError> {
    let scene = contact.scene([load])?;
    memory_check::check_scene(&scene)?;
    let surface = Surface::build(&scene)?;
    // Of a grid that a height file carries.
    memory_check::check_grid(&scene, surface.grid)?;
    let setup = Setup::new(scene, surface);
    let device = SelectedDevice::new(&setup, contact.device.hears_drivers())?;
    Ok((setup, device))
}

impl Course {
    /// A path before its first load.
    fn new(setup: Setup, device: SelectedDevice, threads: Threads) -> Course {
        Course {
            walk: Mutex::new(Walk::begin(&setup, Earlier::default())),
            finished: device.fallback(&setup).map(|_| Earlier::default()),
            remarks: device.remark.iter().cloned().collect(),
            setup,
            device,
            threads,
            given: None,
        }
    }

    /// The load behind the path and behind those that were solved so far; `None` where the surfaces are apart.
    fn load_behind(&mut self) -> Option<Load> {
        let rows = &lock(&mut self.walk).so_far().rows;
        let setup = &self.setup;
        let given = self
            .given
            .get_or_insert_with(|| setup.scene.loading.clone());
        let Planned { value, duration } = Planned::behind(setup, given, rows)?;
        let control = Control::from_kind(given.control, value);
        Some(if given.durations.is_some() {
            control.after(duration)
        } else {
            control.into()
        })
    }

    /// Solves the last load of the path. Where the device fails and another can continue, that one does.
    fn step(&mut self, contact: &Contact) -> Result<Solution, ContactError> {
        match (self.solve(contact), self.device.fallback(&self.setup)) {
            (Err(ContactError::Backend(error)), Some(device)) => {
                let remark =
                    format!("{error}; the processor continues after the last finished load");
                self.remarks.push(remark);
                self.device = device;
                let finished = self.finished.take().unwrap_or_default();
                self.walk = Mutex::new(Walk::begin(&self.setup, finished));
                self.solve(contact)
            }
            (solved, _) => solved,
        }
    }

    fn solve(&mut self, contact: &Contact) -> Result<Solution, ContactError> {
        let (setup, device, walk) = (&self.setup, &self.device, lock(&mut self.walk));
        let mut last = LastStep {
            setup,
            remarks: &mut self.remarks,
            watcher: contact.watcher.as_ref(),
            keeps_state: self.finished.is_some(),
            evaluation: None,
            jump: None,
            checkpoint: Checkpoint::default(),
        };
        let make_backend = || device.backend();
        self.threads.run(|| {
            match walk.step(setup, &make_backend, &mut last) {
                Ok(_) => {}
                Err(WalkError::Backend(error)) => return Err(error.into()),
                Err(WalkError::Observer(never)) => match never {},
            }
            let so_far = walk.so_far();
            if so_far.interrupted {
                return Err(ContactError::Interrupted);
            }
            if let Some(finished) = &mut self.finished {
                *finished = Earlier {
                    rows: so_far.rows.clone(),
                    checkpoint: last.checkpoint,
                };
            }
            let row = so_far.rows.last().cloned();
            let row = row.expect("a step that is not interrupted has a row");
            let (pull_off, unreachable) = (so_far.pull_off, so_far.unreachable);
            Ok(Solution::new(
                setup,
                row,
                last.evaluation,
                last.jump,
                pull_off,
                unreachable,
            ))
        })
    }
}

/// What is behind a lock that nobody else can hold.
fn lock(walk: &mut Mutex<Walk>) -> &mut Walk {
    walk.get_mut().unwrap_or_else(PoisonError::into_inner)
}

/// Checks the newest load of a path with the one before it: those before them have been checked.
fn check(scene: &Scene) -> Result<(), ContactError> {
    let mut newest = scene.clone();
    let loading = &mut newest.loading;
    let older = loading.path.len().saturating_sub(2);
    loading.path.drain(..older);
    if let Some(durations) = &mut loading.durations {
        durations.drain(..older);
    }
    Ok(newest.check()?)
}

/// Keeps what the last step leaves.
struct LastStep<'c> {
    setup: &'c Setup,
    /// What the steps of the path have warned of.
    remarks: &'c mut Vec<String>,
    watcher: Option<&'c Watcher>,
    /// Whether another path may have to go on from the state after it.
    keeps_state: bool,
    evaluation: Option<Evaluation>,
    jump: Option<Jump>,
    checkpoint: Checkpoint,
}

impl Observer for LastStep<'_> {
    type Error = std::convert::Infallible;

    fn step(&mut self, step: FinishedStep) -> Result<(), Self::Error> {
        let warnings = step_warnings(self.setup, &step, self.remarks);
        self.remarks.extend(warnings);
        self.evaluation = step.evaluation;
        self.jump = step.jump;
        Ok(())
    }

    fn iteration(&mut self, _: usize, scalars: &Scalars) -> bool {
        let (iteration, residual) = (scalars.iterations as usize, scalars.residual);
        self.watcher
            .is_none_or(|watcher| watcher.hears(iteration, residual))
    }

    fn wants_checkpoint(&self) -> bool {
        self.keeps_state
    }

    fn checkpoint(&mut self, _: usize, state: &Checkpoint) -> Result<(), Self::Error> {
        self.checkpoint = state.clone();
        Ok(())
    }
}
