//! What a scene costs: fields, bytes and passes, counted without running anything.

use super::control::Controller;
use super::setup::Setup;
use crate::backend::{
    BackendError, Level,
    tally::{Held, Tally},
};
use crate::solver::{ContactSolver, Start};

/// What a scene's solver holds and does, and what is kept between its steps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cost {
    /// Fields, one number a solved point each.
    pub fields: Vec<Held>,
    /// Factors a wavevector.
    pub spectra: Vec<Held>,
    /// Work space of the transforms.
    pub work: Vec<Held>,
    /// Passes of one iteration, in order; `multiply` stands for the columns of a convolution.
    pub passes: Vec<&'static str>,
    /// Solved points of the finest level.
    pub points: [usize; 2],
}

impl Cost {
    /// Plans a scene on a tally: its solver and one iteration of its first load.
    pub fn of(setup: &Setup) -> Result<Cost, BackendError> {
        let mut started = Tally::new();
        begin(setup, &mut started)?;
        let before = started.passes.len();
        let mut iterated = Tally::new();
        begin(setup, &mut iterated)?.iterate()?;
        if let Some(mistake) = iterated.mistake {
            return Err(mistake);
        }
        let branches = setup.scene.solid.relaxation.len();
        if branches > 0 {
            // The displacement and the spring of each branch, kept by the host.
            let history = Held {
                name: "history",
                level: Level(0),
                bytes: setup.problem.shape.len() * size_of::<f64>(),
            };
            iterated.fields.extend(vec![history; branches + 1]);
        }
        Ok(Cost {
            fields: iterated.fields,
            spectra: iterated.spectra,
            work: iterated.work,
            passes: iterated.passes.split_off(before),
            points: setup.problem.shape.points,
        })
    }

    /// Bytes of all that is held on the device.
    pub fn bytes(&self) -> usize {
        [&self.fields, &self.spectra, &self.work]
            .into_iter()
            .flatten()
            .map(|held| held.bytes)
            .sum()
    }
}

fn begin<'a>(setup: &'a Setup, tally: &'a mut Tally) -> Result<ContactSolver<'a>, BackendError> {
    let controller = Controller::new(setup, &setup.problem);
    let value = setup.scene.loading.path.first().copied().unwrap_or(0.0);
    let load = controller.load(value);
    let mut solver = ContactSolver::new(tally, &setup.problem);
    solver.begin(&load, &Start::Present, setup.scene.solver.tolerance, false)?;
    Ok(solver)
}
