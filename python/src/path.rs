//! Loads solved one after another, each from the state of the one before.

use std::collections::VecDeque;
use std::process;
use std::sync::{Arc, Mutex, PoisonError};

use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use tabor::{Jump, Load, Path, Solution};

use crate::arrays::{Lent, array};
use crate::errors;
use crate::scene::{LoadedScene, contact, control};
use crate::waiting::{Talk, wait};

/// Loads that Python has asked for and the solver has not yet taken.
#[derive(Clone, Default)]
struct Loads(Arc<Mutex<VecDeque<Load>>>);

impl Loads {
    fn push(&self, load: Load) {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push_back(load);
    }
}

impl Iterator for Loads {
    type Item = Load;

    fn next(&mut self) -> Option<Load> {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .pop_front()
    }
}

/// A path of loads.
#[pyclass(module = "tabor._tabor")]
pub struct SolvedPath {
    loads: Loads,
    talk: Arc<Talk>,
    /// Lent to the solver's thread while a load is solved; gone after one was interrupted.
    path: Option<Path<Loads>>,
    /// The process that its threads are in, from the first load on: a fork has none of them.
    process: Option<u32>,
    lent: Vec<Lent>,
    /// The heights of all steps, once there is one, of a solid that keeps its shape.
    heights: Option<Py<PyArray2<f64>>>,
    keeps_shape: bool,
    warned: usize,
    /// Who tells messages about its scene and its loads.
    teller: Option<Py<PyAny>>,
}

impl SolvedPath {
    /// The path of a scene, before its first load, which goes on behind its loads where it shall end with the surfaces
    /// apart.
    pub fn new(
        py: Python<'_>,
        loaded: &LoadedScene,
        threads: Option<usize>,
        until_apart: bool,
        teller: Option<Py<PyAny>>,
    ) -> Self {
        let (loads, talk) = (Loads::default(), Arc::new(Talk::default()));
        let heard = Arc::clone(&talk);
        let contact = contact(&loaded.scene, threads)
            .watch(move |iteration, residual| heard.iteration(iteration, residual));
        let path = contact.path(loads.clone());
        SolvedPath {
            path: Some(if until_apart {
                path.until_apart()
            } else {
                path
            }),
            lent: loaded.lent.iter().map(|each| each.share(py)).collect(),
            loads,
            process: None,
            talk,
            heights: None,
            keeps_shape: loaded.scene.solid.hardness.is_none(),
            warned: 0,
            teller,
        }
    }
}

#[pymethods]
impl SolvedPath {
    /// Solves the next load: its control in a scene's word, its value, SI, and the seconds that it takes. Returns the step
    /// as a dictionary; the warnings that are new are added to `said`, also where the load is refused.
    #[pyo3(signature = (word, value, seconds, said, progress=None))]
    fn solve<'py>(
        &mut self,
        py: Python<'py>,
        word: &str,
        value: f64,
        seconds: Option<f64>,
        said: &Bound<'py, PyList>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let control = control(py, word, value)?;
        // Before the load is taken: one that is not solved would be the next one's.
        Lent::check(py, &self.lent)?;
        self.loads.push(match seconds {
            Some(seconds) => control.after(seconds),
            None => control.into(),
        });
        self.next(py, said, progress)?
            .ok_or_else(|| errors::failed(py, "this path has ended: a load did not converge"))
    }

    /// Solves the load behind those that were given; None where the surfaces are apart.
    #[pyo3(signature = (said, progress=None))]
    fn pull<'py>(
        &mut self,
        py: Python<'py>,
        said: &Bound<'py, PyList>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        Lent::check(py, &self.lent)?;
        self.next(py, said, progress)
    }

    /// Adds to `said` what a path that has ended shows as a whole; nothing where another process began it, or where it was
    /// interrupted.
    fn conclude(&mut self, said: &Bound<'_, PyList>) -> PyResult<()> {
        let is_own = self.process.is_none_or(|own| own == process::id());
        if let Some(path) = self.path.as_mut().filter(|_| is_own) {
            path.conclude();
            for words in path.warnings().split_off(self.warned) {
                self.warned += 1;
                said.append(words)?;
            }
        }
        Ok(())
    }
}

impl SolvedPath {
    /// Solves the next load of the path, if there is one.
    fn next<'py>(
        &mut self,
        py: Python<'py>,
        said: &Bound<'py, PyList>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        if *self.process.get_or_insert_with(process::id) != process::id() {
            return Err(errors::failed(
                py,
                "this path was begun in another process, which has its threads; begin another",
            ));
        }
        let Some(mut path) = self.path.take() else {
            return Err(errors::failed(
                py,
                "this path was interrupted; begin another",
            ));
        };
        self.talk.begin();
        let (path, solved) = wait(py, &self.talk, progress, move || {
            let solved = path.next();
            (path, solved)
        })?;
        let warnings = path.warnings().split_off(self.warned);
        self.warned += warnings.len();
        self.path = Some(path);
        for words in warnings {
            said.append(words)?;
        }
        if let Some(Ok(solution)) = &solved {
            self.talk.finished(solution.row.step);
        }
        match solved {
            Some(Ok(solution)) => self.step(py, solution).map(Some),
            Some(Err(error)) => Err(errors::of_contact(py, self.teller.as_ref(), &error)),
            None => Ok(None),
        }
    }

    /// A solved load; its fields are handed over, and its heights are one array for all steps that share them.
    fn step<'py>(&mut self, py: Python<'py>, solution: Solution) -> PyResult<Bound<'py, PyDict>> {
        let (heights, points) = (solution.heights.clone(), solution.points);
        let step = table(py, solution)?;
        let heights = match &self.heights {
            Some(kept) => kept.bind(py).clone(),
            None => {
                let heights = array(py, heights.into_vec(), points)?;
                if self.keeps_shape {
                    heights.getattr("flags")?.setattr("writeable", false)?;
                    self.heights = Some(heights.clone().unbind());
                }
                heights
            }
        };
        step.set_item("heights", heights)?;
        Ok(step)
    }
}

/// A solved load but for its heights.
fn table<'py>(py: Python<'py>, solution: Solution) -> PyResult<Bound<'py, PyDict>> {
    let step = PyDict::new(py);
    let points = solution.points;
    step.set_item("size", solution.size)?;
    step.set_item("gap", array(py, solution.gap, points)?)?;
    step.set_item("pressure", array(py, solution.pressure, points)?)?;
    step.set_item("displacement", array(py, solution.displacement, points)?)?;
    let row = &solution.row;
    step.set_item("number", row.step)?;
    step.set_item("time", row.time)?;
    step.set_item("contact_area_fraction", row.contact_area_fraction)?;
    step.set_item(
        "contact_area_fraction_corrected",
        row.contact_area_fraction_corrected,
    )?;
    step.set_item("attractive_area_fraction", row.attractive_area_fraction)?;
    step.set_item("force", row.force)?;
    step.set_item("mean_pressure", row.mean_pressure)?;
    step.set_item("approach", row.approach)?;
    step.set_item("mean_gap", row.mean_gap)?;
    step.set_item("elastic_energy", row.elastic_energy)?;
    step.set_item("adhesive_energy", row.adhesive_energy)?;
    step.set_item("residual", row.residual)?;
    step.set_item("iterations", row.iterations)?;
    step.set_item("converged", row.converged)?;
    let why = solution.unreachable.map(|why| why.to_string());
    step.set_item("unreachable", why)?;
    step.set_item("seconds", row.seconds)?;
    step.set_item("state", row.state.name())?;
    let jump = solution.jump.map(|jump| match jump {
        Jump::In => "in",
        _ => "off",
    });
    step.set_item("jump", jump)?;
    step.set_item(
        "pull_off",
        solution.pull_off.map(|[held, parted]| (held, parted)),
    )?;
    let columns = PyDict::new(py);
    for (column, value) in &row.columns {
        columns.set_item(column.name(), *value)?;
    }
    step.set_item("columns", columns)?;
    Ok(step)
}
