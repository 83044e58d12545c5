//! Scenes: TOML in, a checked [`Scene`] out, or every mistake of it at once.
//!
//! `document` parses the text into a tree with line numbers, `overrides` applies `--set`, and one
//! file for each table reads the tree through a `reader` that collects mistakes. Everything that
//! can be refused without a height file or the machine is refused here; later code may rely on it.

mod adhesion;
mod allowed;
mod attraction;
mod capillary;
mod check;
mod conductance;
mod constructors;
mod document;
mod grid;
mod grid_values;
mod hardness;
mod keys;
mod laws;
mod leakage;
mod loading;
mod mistake;
mod output;
mod overrides;
mod parts;
mod rate;
mod reader;
mod resolved;
mod solid;
mod solver;
mod suggestion;
mod surface;
mod tables;
mod time_steps;
mod types;
mod words;

use std::io::Read;
use std::path::{Path, PathBuf};

pub use attraction::*;
pub use check::Ramp;
pub use conductance::Conduction;
pub use grid_values::GridValues;
#[cfg(feature = "cli")]
pub(crate) use keys::unit_of;
pub use laws::{Exponential, LennardJones, MaugisDugdale};
pub use leakage::Axis;
pub use mistake::{Mistake, SceneError, SceneErrors};
pub use parts::*;
#[cfg(feature = "cli")]
pub(crate) use suggestion::suggestion;
pub use tables::*;
#[doc(hidden)]
pub use time_steps::{DEFAULT_TOLERANCE as DEFAULT_TIME_TOLERANCE, Stretch};
pub use types::*;

use document::{Location, Table};
use reader::{Log, Reader};

/// Longest scene file: a path of a million steps has about 20 bytes a step.
const MOST_BYTES: u64 = 32 << 20;

impl LoadingScene {
    /// How much further than the body what is prescribed is moved under a force (N), m: what a spring between the two is stretched by.
    pub(crate) fn stretched(&self, force: f64) -> f64 {
        self.spring.map_or(0.0, |spring| force / spring)
    }
}

impl Scene {
    /// Whether its surfaces attract each other.
    pub(crate) fn attracts(&self) -> bool {
        self.adhesion.is_some()
    }

    /// The files that it reads: height maps, and the map of its adhesion.
    #[cfg(feature = "cli")]
    pub(crate) fn files(&self) -> impl Iterator<Item = &Path> {
        let heights = self.surfaces.iter().filter_map(|part| match part {
            SurfacePart::File(file) => Some(file.path.as_path()),
            _ => None,
        });
        let map = self.adhesion.as_ref().and_then(|it| match &it.map {
            Some(AdhesionMap::File(path)) => Some(path.as_path()),
            _ => None,
        });
        heights.chain(map)
    }

    /// Reads a scene file, with `overrides` as `--set KEY=VALUE` gives them.
    ///
    /// # Errors
    /// Every mistake of the scene, or that the file cannot be read.
    pub fn read(path: &Path, overrides: &[(String, String)]) -> Result<Scene, SceneErrors> {
        let file_name = path.display().to_string();
        let text = read_text(path).map_err(|reason| {
            let log = Log::new(&file_name);
            log.add(Location::Nowhere, "", SceneError::Unreadable { reason });
            log.into_errors()
        })?;
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent.to_path_buf(),
            _ => PathBuf::from("."),
        };
        Scene::parse(&text, &file_name, &folder, overrides)
    }

    /// Parses the text of a scene. Messages call it `file_name`, and its paths are relative to
    /// `folder`.
    ///
    /// # Errors
    /// Every mistake of the scene; of a syntax error only the first.
    pub fn parse(
        text: &str,
        file_name: &str,
        folder: &Path,
        overrides: &[(String, String)],
    ) -> Result<Scene, SceneErrors> {
        let log = Log::new(file_name);
        let scene = match document::parse(text) {
            Ok(root) if root.get("axis").is_some() && root.get("grid").is_none() => {
                let reason = "this is a study of many runs, which `tabor sweep` solves".to_owned();
                log.add(Location::Nowhere, "", SceneError::Conflict { reason });
                None
            }
            Ok(mut root) => {
                overrides::apply(&mut root, overrides, &log);
                read_tables(&root, folder, &log)
            }
            Err((line, error)) => {
                log.add(line.map_or(Location::Nowhere, Location::Line), "", error);
                None
            }
        };
        match scene {
            Some(scene) if log.is_empty() => Ok(scene),
            _ => Err(log.into_errors()),
        }
    }
}

/// The text of a scene file, or why it cannot be read.
fn read_text(path: &Path) -> Result<String, String> {
    let said = |error: std::io::Error| error.to_string();
    let metadata = std::fs::metadata(path).map_err(said)?;
    if !metadata.is_file() {
        // A device never ends, and a pipe has no known length.
        return Err(
            "it is not a regular file (but a folder, a pipe or a device); save the scene to a file and name that"
                .to_string(),
        );
    }
    if metadata.len() > MOST_BYTES {
        return Err(format!(
            "{} bytes are too many for a scene, which may have {MOST_BYTES}; name its TOML file",
            metadata.len()
        ));
    }
    let mut bytes = Vec::new();
    // If the file grows while it is read, the extra bytes are ignored.
    let file = std::fs::File::open(path).map_err(said)?;
    file.take(metadata.len())
        .read_to_end(&mut bytes)
        .map_err(said)?;
    String::from_utf8(bytes).map_err(|_| "it is not UTF-8 text".to_string())
}

/// Reads every table before returning, so that all mistakes are collected.
fn read_tables(root: &Table, folder: &Path, log: &Log) -> Option<Scene> {
    let scene = Reader::open(root, Location::Nowhere, "", &keys::SCENE, log);
    let title = if scene.has("title") {
        scene.text("title").map(|title| Some(title.to_string()))
    } else {
        Some(None)
    };
    let grid = grid::read(&scene, grid::has_height_file(root));
    let boundary = grid.as_ref().map(|grid| grid.boundary);
    let solid = solid::read(&scene, boundary);
    let relaxes = solid
        .as_ref()
        .is_some_and(|solid| !solid.relaxation.is_empty());
    let surfaces = surface::read(&scene, grid.as_ref(), folder);
    let adhesion = adhesion::read(&scene, grid.as_ref(), folder, relaxes);
    let capillary = capillary::read(&scene);
    let adhesion = match &capillary {
        Some(Some(liquid)) => adhesion.map(|_| liquid.adhesion()),
        _ => adhesion,
    };
    let law = adhesion.as_ref().and_then(Option::as_ref);
    let loading = loading::read(&scene, boundary, law, solid.as_ref());
    let solver = solver::read(&scene);
    if let Some(solid) = &solid {
        hardness::check(&scene, solid, law, loading.as_ref(), grid.as_ref());
        hardness::check_precision(&scene, solid, solver.as_ref());
    }
    let tables = EffectTables::read(&scene);
    if let Some(solid) = &solid {
        conductance::check(&scene, solid);
    }
    let planned = loading.as_ref().filter(|loading| !loading.until_apart);
    let path_length = planned.map(|loading| loading.path.len());
    let output = output::read(&scene, path_length);
    Some(Scene {
        title: title?,
        grid: grid?,
        solid: solid?,
        surfaces: surfaces?,
        adhesion: adhesion?,
        capillary: capillary?,
        tables: tables?,
        loading: loading?,
        solver: solver?,
        output: output?,
        folder: folder.to_path_buf(),
    })
}
