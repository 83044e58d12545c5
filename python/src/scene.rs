//! Scenes: text and arrays in, solvable contacts out.

use std::path::Path as FilePath;
use std::sync::Arc;

use numpy::PyArray2;
use pyo3::prelude::*;
use tabor::scene::{AdhesionMap, Scene, SurfacePart};
use tabor::{Contact, ContactError, Control};

use crate::arrays::{Lent, array};
use crate::errors::{self, Teller};
use crate::path::SolvedPath;
use crate::waiting::{Talk, wait};

/// A scene that has been read and checked, with arrays in place of files where they were given.
#[pyclass(frozen, module = "tabor._tabor")]
pub struct LoadedScene {
    pub scene: Scene,
    /// The arrays that it shares with whoever gave them.
    pub lent: Vec<Lent>,
    /// Who tells messages about it.
    teller: Option<Py<PyAny>>,
}

impl LoadedScene {
    /// Who tells messages about it.
    pub fn teller(&self) -> Teller<'_> {
        self.teller.as_ref()
    }
}

/// A surface that was built: heights, size of its cell, warnings.
type Built<'py> = (Bound<'py, PyArray2<f64>>, [f64; 2], Vec<String>);

#[pymethods]
impl LoadedScene {
    /// Reads the text of a scene; paths in it are relative to `folder`. Messages call it `name`, or `teller` tells them.
    #[new]
    #[pyo3(signature = (text, name, folder, overrides, heights=None, factors=None, teller=None))]
    #[expect(clippy::too_many_arguments, reason = "Python names each of them")]
    fn new(
        py: Python<'_>,
        text: &str,
        name: &str,
        folder: &str,
        overrides: Vec<(String, String)>,
        heights: Option<&Bound<'_, PyArray2<f64>>>,
        factors: Option<&Bound<'_, PyArray2<f64>>>,
        teller: Option<Py<PyAny>>,
    ) -> PyResult<Self> {
        let refused = |mistakes| errors::of_scene(py, teller.as_ref(), &mistakes);
        let mut scene =
            Scene::parse(text, name, FilePath::new(folder), &overrides).map_err(refused)?;
        let mut lent = Vec::new();
        if let Some(heights) = heights {
            let heights = Lent::new(heights, "heights")?;
            // A scene has a part: where heights are all there is, the text names a flat one.
            let part = SurfacePart::Heights(heights.values());
            lent.push(heights);
            match scene.surfaces.as_mut_slice() {
                [only @ SurfacePart::Flat] => *only = part,
                _ => scene.surfaces.insert(0, part),
            }
        }
        if let (Some(factors), Some(adhesion)) = (factors, &mut scene.adhesion) {
            let factors = Lent::new(factors, "adhesion_map")?;
            adhesion.map = Some(AdhesionMap::Factors(factors.values()));
            lent.push(factors);
        }
        scene.check().map_err(refused)?;
        Ok(LoadedScene {
            scene,
            lent,
            teller,
        })
    }

    /// The scene with every default filled in, SI, as JSON.
    fn resolved_json(&self) -> String {
        self.scene.resolved_json().to_string()
    }

    /// Refuses arrays that were written to, before their numbers leave the scene.
    fn check_arrays(&self, py: Python<'_>) -> PyResult<()> {
        Lent::check(py, &self.lent)
    }

    /// The loads of the scene: its control, in its word, each value, SI, and the seconds that it takes.
    fn loads(&self) -> Vec<(&'static str, f64, Option<f64>)> {
        let loading = &self.scene.loading;
        let seconds = |index: usize| Some(loading.durations.as_ref()?[index]);
        let values = loading.path.iter().enumerate();
        values
            .map(|(index, &value)| (loading.control.name(), value, seconds(index)))
            .collect()
    }

    /// A path, to be solved load by load, of which `teller` tells.
    #[pyo3(signature = (threads=None, until_apart=false, teller=None))]
    fn path(
        &self,
        py: Python<'_>,
        threads: Option<usize>,
        until_apart: bool,
        teller: Option<Py<PyAny>>,
    ) -> SolvedPath {
        SolvedPath::new(py, self, threads, until_apart, teller)
    }

    /// The heights of all parts, m, as an array of shape (ny, nx), (lx, ly), m, and warnings.
    #[pyo3(signature = (threads=None))]
    fn heights<'py>(&self, py: Python<'py>, threads: Option<usize>) -> PyResult<Built<'py>> {
        Lent::check(py, &self.lent)?;
        let scene = self.scene.clone();
        let talk = Arc::new(Talk::default());
        let built = wait(py, &talk, None, move || {
            tabor::backend::cpu::with_threads(threads, || tabor::surface::Surface::build(&scene))
                .map_err(ContactError::from)
                .and_then(|built| built.map_err(ContactError::from))
        })?;
        let surface = built.map_err(|error| errors::of_contact(py, self.teller(), &error))?;
        let (grid, warnings) = (surface.grid, surface.warnings);
        let heights = surface.heights.into_vec();
        Ok((array(py, heights, grid.points())?, grid.size(), warnings))
    }
}

/// A control of a scene's word.
pub fn control(py: Python<'_>, word: &str, value: f64) -> PyResult<Control> {
    match word {
        "pressure" => Ok(Control::MeanPressure(value)),
        "force" => Ok(Control::Force(value)),
        "approach" => Ok(Control::Approach(value)),
        "mean-gap" => Ok(Control::MeanGap(value)),
        other => Err(errors::failed(py, &format!("no control is called {other}"))),
    }
}

/// Contact of a scene.
pub fn contact(scene: &Scene, threads: Option<usize>) -> Contact {
    let contact = Contact::from_scene(scene.clone());
    match threads {
        Some(threads) => contact.threads(threads),
        None => contact,
    }
}

/// TOML of the tables of a scene, given as JSON.
#[pyfunction]
pub fn toml_from_json(py: Python<'_>, json: &str) -> PyResult<String> {
    let tables: toml::Table = serde_json::from_str(json)
        .map_err(|error| errors::raise(py, "SceneError", &error.to_string()))?;
    toml::to_string(&tables).map_err(|error| errors::raise(py, "SceneError", &error.to_string()))
}

/// A value, given as JSON, as TOML writes it behind a key, on one line: tables and lists of them within braces.
#[pyfunction]
pub fn toml_value_from_json(py: Python<'_>, json: &str) -> PyResult<String> {
    let value: toml::Value = serde_json::from_str(json)
        .map_err(|error| errors::raise(py, "SceneError", &error.to_string()))?;
    Ok(value.to_string())
}

/// The tables of a scene as JSON; of a syntax error its words.
#[pyfunction]
pub fn json_from_toml(py: Python<'_>, text: &str) -> PyResult<String> {
    let tables: toml::Table = text
        .parse()
        .map_err(|error: toml::de::Error| errors::raise(py, "SceneError", &error.to_string()))?;
    serde_json::to_string(&tables)
        .map_err(|error| errors::raise(py, "SceneError", &error.to_string()))
}
