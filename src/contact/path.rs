//! Loads solved one after another.

use super::builder::{Contact, Watcher, append};
use super::control::{Control, Load};
use super::error::ContactError;
use super::solution::Solution;
use crate::backend::cpu::with_threads;
use crate::device::SelectedDevice;
use crate::kernel::Scalars;
use crate::run::memory_check;
use crate::scene::{LoadingScene, Scene};
use crate::study::{
    Checkpoint, Earlier, Evaluation, FinishedStep, Jump, Observer, Planned, Setup, WalkError,
    walk_on,
};
use crate::surface::Surface;

/// Solutions of loads, one after another, each from the state of the one before; see [`Contact::path`].
pub struct Path<I> {
    contact: Contact,
    loads: I,
    /// From the first load on.
    walk: Option<Walk>,
    /// Whether it goes on behind its loads.
    until_apart: bool,
    ended: bool,
}

/// A path on its way.
struct Walk {
    setup: Setup,
    device: SelectedDevice,
    earlier: Earlier,
    /// The loads that were given, once there are further ones.
    given: Option<LoadingScene>,
    remarks: Vec<String>,
}

impl<I> Path<I> {
    pub(super) fn new(contact: Contact, loads: I) -> Self {
        Path {
            contact,
            loads,
            walk: None,
            until_apart: false,
            ended: false,
        }
    }

    /// Goes on behind the loads, outwards, in steps that become finer, until the surfaces are apart: the steps of a
    /// scene with `until = "apart"`.
    pub fn until_apart(mut self) -> Self {
        self.until_apart = true;
        self
    }

    /// Warnings of the contact, one sentence each, from the first load on: waves that the grid
    /// does not resolve, a cohesive zone of too few pixels, and on which device it is solved.
    pub fn warnings(&self) -> Vec<String> {
        match &self.walk {
            None => Vec::new(),
            Some(walk) => [walk.setup.warnings.as_slice(), &walk.remarks].concat(),
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
        if self.ended {
            return None;
        }
        let load = match self.loads.next() {
            Some(load) => load.into(),
            None if self.until_apart => self.walk.as_mut()?.load_behind()?,
            None => return None,
        };
        let solved = self.solve(load);
        self.ended = !solved.as_ref().is_ok_and(|solution| solution.converged);
        Some(solved)
    }
}

impl<I> Path<I> {
    fn solve(&mut self, load: Load) -> Result<Solution, ContactError> {
        let contact = &self.contact;
        let walk = match &mut self.walk {
            Some(walk) => {
                append(&mut walk.setup.scene, load)?;
                check(&walk.setup.scene)?;
                walk
            }
            // The surface is built by the same threads as the loads are solved.
            None => {
                let begun = with_threads(contact.threads, || Walk::begin(contact, load))??;
                self.walk.insert(begun)
            }
        };
        walk.step(contact)
    }
}

impl Walk {
    /// Makes everything ready for the first load.
    fn begin(contact: &Contact, load: Load) -> Result<Walk, ContactError> {
        let scene = contact.scene([load])?;
        memory_check::check_scene(&scene)?;
        let surface = Surface::build(&scene)?;
        // Of a grid that a height file carries.
        memory_check::check_grid(&scene, surface.grid)?;
        let setup = Setup::new(scene, surface);
        let device = SelectedDevice::new(&setup, contact.device.hears_drivers())?;
        Ok(Walk {
            remarks: device.remark.iter().cloned().collect(),
            setup,
            device,
            earlier: Earlier::default(),
            given: None,
        })
    }

    /// The load behind the path and behind those that were solved so far; `None` where the surfaces are apart.
    fn load_behind(&mut self) -> Option<Load> {
        let setup = &self.setup;
        let given = self
            .given
            .get_or_insert_with(|| setup.scene.loading.clone());
        let Planned { value, duration } = Planned::behind(setup, given, &self.earlier.rows)?;
        let control = Control::from_kind(given.control, value);
        Some(if given.durations.is_some() {
            control.after(duration)
        } else {
            control.into()
        })
    }

    /// Solves the last load of the path. Where the device fails and another can continue, that one does.
    fn step(&mut self, contact: &Contact) -> Result<Solution, ContactError> {
        let earlier = std::mem::take(&mut self.earlier);
        let fallback = self.device.fallback(&self.setup);
        let again = fallback.map(|device| (device, earlier.clone()));
        match (self.solve(earlier, contact), again) {
            (Err(ContactError::Backend(error)), Some((device, earlier))) => {
                let remark =
                    format!("{error}; the processor continues after the last finished load");
                self.remarks.push(remark);
                self.device = device;
                self.solve(earlier, contact)
            }
            (solved, _) => solved,
        }
    }

    fn solve(&mut self, earlier: Earlier, contact: &Contact) -> Result<Solution, ContactError> {
        let (setup, device) = (&self.setup, &self.device);
        let mut last = LastStep {
            watcher: contact.watcher.as_ref(),
            ..LastStep::default()
        };
        let make_backend = || device.backend();
        let walked = with_threads(contact.threads, || {
            walk_on(setup, &make_backend, &mut last, earlier)
        })?;
        let mut end = match walked {
            Ok(end) => end,
            Err(WalkError::Backend(error)) => return Err(error.into()),
            Err(WalkError::Observer(never)) => match never {},
        };
        if end.interrupted {
            return Err(ContactError::Interrupted);
        }
        let row = end
            .rows
            .last()
            .cloned()
            .expect("a step that is not interrupted has a row");
        self.earlier = Earlier {
            rows: std::mem::take(&mut end.rows),
            checkpoint: last.checkpoint,
        };
        Ok(Solution::new(
            setup,
            row,
            last.evaluation,
            last.jump,
            end.pull_off,
        ))
    }
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
#[derive(Default)]
struct LastStep<'c> {
    watcher: Option<&'c Watcher>,
    evaluation: Option<Evaluation>,
    jump: Option<Jump>,
    checkpoint: Checkpoint,
}

impl Observer for LastStep<'_> {
    type Error = std::convert::Infallible;

    fn step(&mut self, step: FinishedStep) -> Result<(), Self::Error> {
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
        true
    }

    fn checkpoint(&mut self, _: usize, state: &Checkpoint) -> Result<(), Self::Error> {
        self.checkpoint = state.clone();
        Ok(())
    }
}
