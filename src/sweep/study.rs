//! A study file: a scene, its axes, what is kept and drawn.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::axis::{Axis, AxisTable};
use super::cases::{Case, cases};
use super::error::SweepError;
use crate::scene::{Scene, SceneErrors};

/// Most cases of a study.
const MOST_CASES: usize = 1_000_000;
/// Longest study file, bytes.
const MOST_BYTES: u64 = 8 << 20;

/// A study as it is written.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct StudyTable {
    title: Option<String>,
    scene: PathBuf,
    #[serde(default)]
    set: BTreeMap<String, toml::Value>,
    #[serde(default)]
    axis: Vec<AxisTable>,
    #[serde(default)]
    folders: Folders,
    #[serde(default)]
    plot: PlotTable,
}

/// The cases whose folders are kept.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq)]
#[serde(untagged)]
enum Folders {
    Word(FolderWord),
    Numbers(Vec<usize>),
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
enum FolderWord {
    None,
    All,
}

impl Default for Folders {
    fn default() -> Self {
        Folders::Word(FolderWord::None)
    }
}

/// What the picture shows.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(deny_unknown_fields)]
pub(super) struct PlotTable {
    /// The key along x.
    pub x: Option<String>,
    /// The quantity along y.
    pub y: Option<String>,
    /// The key of which each value has a curve.
    pub series: Option<String>,
}

/// A study: a scene over values of its keys.
#[derive(Clone, Debug)]
pub struct Study {
    path: PathBuf,
    title: Option<String>,
    scene: PathBuf,
    set: Vec<(String, String)>,
    axes: Vec<Axis>,
    folders: Folders,
    pub(super) plot: PlotTable,
    /// Identifies the study: the scene of its first case and all its axes.
    fingerprint: String,
}

impl Study {
    /// Reads a study file and checks each value of each axis in a scene; `overrides` are those of `--set`, and come
    /// before the axes.
    ///
    /// # Errors
    /// A file that is not a study, an axis without values, a key or value that the scene does not take.
    pub fn read(path: &Path, overrides: &[(String, String)]) -> Result<Study, SweepError> {
        let text = read_text(path)?;
        let table: StudyTable = toml::from_str(&text).map_err(|error| SweepError::Syntax {
            path: path.to_path_buf(),
            reason: error.to_string().trim_end().to_owned(),
        })?;
        if table.axis.is_empty() {
            return Err(SweepError::NoAxis { path: path.into() });
        }
        let axes = table
            .axis
            .iter()
            .enumerate()
            .map(|(index, axis)| {
                axis.read().map_err(|reason| SweepError::Axis {
                    path: path.to_path_buf(),
                    axis: index + 1,
                    key: axis.words(),
                    reason,
                })
            })
            .collect::<Result<Vec<Axis>, SweepError>>()?;
        let count = axes.iter().map(|axis| axis.values.len() as u128).product();
        if count > MOST_CASES as u128 {
            return Err(SweepError::TooMany {
                path: path.to_path_buf(),
                count,
                most: MOST_CASES,
            });
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        let set = table
            .set
            .iter()
            .map(|(key, value)| (key.clone(), value.to_string()));
        let mut study = Study {
            path: path.to_path_buf(),
            title: table.title,
            scene: folder.join(table.scene),
            set: set.chain(overrides.iter().cloned()).collect(),
            axes,
            folders: table.folders,
            plot: table.plot,
            fingerprint: String::new(),
        };
        study.fingerprint = study.check()?;
        Ok(study)
    }

    /// Reads the scene with each value of each axis, the others at their first; returns the fingerprint.
    fn check(&self) -> Result<String, SweepError> {
        let mut first: Vec<usize> = vec![0; self.axes.len()];
        let scene = self.checked(&first)?;
        for axis in 0..self.axes.len() {
            for value in 1..self.axes[axis].values.len() {
                first[axis] = value;
                self.checked(&first)?;
            }
            first[axis] = 0;
        }
        for (key, name) in [("x", &self.plot.x), ("series", &self.plot.series)] {
            if let Some(name) = name
                && !self.keys().any(|known| known == name)
            {
                let known: Vec<&str> = self.keys().collect();
                return Err(SweepError::Plot {
                    path: self.path.clone(),
                    key,
                    reason: format!(
                        "{name} is not the key of an axis; these are: {}",
                        known.join(", ")
                    ),
                });
            }
        }
        if let Some(y) = &self.plot.y
            && !super::outcome::QUANTITIES.contains(&y.as_str())
        {
            return Err(SweepError::Plot {
                path: self.path.clone(),
                key: "y",
                reason: format!(
                    "{y} is not a quantity of a run; these are: {}",
                    super::outcome::QUANTITIES.join(", ")
                ),
            });
        }
        let axes: Vec<serde_json::Value> = self
            .axes
            .iter()
            .map(|axis| serde_json::json!({ "keys": axis.keys, "values": axis.values }))
            .collect();
        let mut resolved = scene.resolved_json();
        resolved["study"] = serde_json::json!(axes);
        Ok(resolved.to_string())
    }

    fn checked(&self, indices: &[usize]) -> Result<Scene, SweepError> {
        let settings = self
            .axes
            .iter()
            .zip(indices)
            .flat_map(|(axis, index)| {
                axis.keys
                    .iter()
                    .cloned()
                    .zip(axis.values[*index].iter().cloned())
            })
            .collect();
        let case = Case {
            number: 0,
            settings,
        };
        self.scene(&case).map_err(|errors| SweepError::Scene {
            path: self.path.clone(),
            case: case.words(),
            errors,
        })
    }

    /// The scene of a case.
    ///
    /// # Errors
    /// Every mistake of it.
    pub fn scene(&self, case: &Case) -> Result<Scene, SceneErrors> {
        let settings: Vec<_> = self.set.iter().chain(&case.settings).cloned().collect();
        Scene::read(&self.scene, &settings)
    }

    /// All cases.
    pub fn cases(&self) -> impl Iterator<Item = Case> {
        cases(&self.axes)
    }

    /// The number of cases.
    pub fn count(&self) -> usize {
        self.axes.iter().map(|axis| axis.values.len()).product()
    }

    /// The keys of all axes.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.axes
            .iter()
            .flat_map(|axis| axis.keys.iter().map(String::as_str))
    }

    /// Whether the folder of a case is kept.
    pub fn keeps(&self, case: &Case) -> bool {
        match &self.folders {
            Folders::Word(word) => *word == FolderWord::All,
            Folders::Numbers(numbers) => numbers.contains(&case.number),
        }
    }

    /// The title, or the name of the file.
    pub fn title(&self) -> String {
        let stem = || {
            self.path
                .file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned()
        };
        self.title.clone().unwrap_or_else(stem)
    }

    /// Identifies the study.
    pub(super) fn fingerprint(&self) -> &str {
        &self.fingerprint
    }
}

fn read_text(path: &Path) -> Result<String, SweepError> {
    let unreadable = |reason: String| SweepError::Unreadable {
        path: path.to_path_buf(),
        reason,
    };
    let metadata = std::fs::metadata(path).map_err(|error| unreadable(error.to_string()))?;
    if !metadata.is_file() || metadata.len() > MOST_BYTES {
        return Err(unreadable(
            "name a TOML file with [[axis]] tables".to_owned(),
        ));
    }
    std::fs::read_to_string(path).map_err(|error| unreadable(error.to_string()))
}
