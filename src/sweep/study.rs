//! A study file: a scene, its axes, what is kept and drawn.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::json;

use super::axis::{Axis, AxisTable};
use super::cases::{Case, cases, value_at};
use super::error::SweepError;
use super::outcome::{quantity_names, written};
use crate::scene::{Scene, SceneError, SceneErrors, unit_of};
use crate::units::parse_any_quantity;

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
    set: toml::Table,
    #[serde(default)]
    axis: Vec<AxisTable>,
    #[serde(default)]
    folders: Folders,
    #[serde(default)]
    plot: PlotTable,
}

/// The cases whose folders are kept.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq)]
#[serde(
    untagged,
    expecting = "folders is \"none\", \"all\" or a list of cases, such as [1, 12]"
)]
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
    /// Identifies the study: the scene of its first case, all its axes, and the content of the files that they name.
    fingerprint: String,
}

impl Study {
    /// Reads a study file and checks each value of each axis in a scene; `overrides` are those of `--set`.
    ///
    /// # Errors
    /// A file that is not a study, an axis without values, a key or value that the scene does not take.
    pub fn read(path: &Path, overrides: &[(String, String)]) -> Result<Study, SweepError> {
        let text = read_text(path)?;
        let table: StudyTable = toml::from_str(&text).map_err(|error| SweepError::Syntax {
            path: path.to_path_buf(),
            reason: if is_scene(&text) {
                "it is a scene, which `tabor run` solves; a study has its name as scene and an [[axis]]".into()
            } else {
                error.to_string().trim_end().to_owned()
            },
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
        let mut set = Vec::new();
        flatten("", &table.set, &mut set);
        let own = set.len();
        set.extend(overrides.iter().cloned());
        let mut study = Study {
            scene: path.parent().unwrap_or(Path::new("")).join(table.scene),
            path: path.to_path_buf(),
            title: table.title,
            set,
            axes,
            folders: table.folders,
            plot: table.plot,
            fingerprint: String::new(),
        };
        study.check_keys(own)?;
        study.check_folders()?;
        study.check_plot()?;
        study.fingerprint = study.check_scenes()?;
        Ok(study)
    }

    /// Refuses a key that is given twice, or that a later axis replaces; the first `own` settings are those of the file.
    fn check_keys(&self, own: usize) -> Result<(), SweepError> {
        let keys: Vec<&str> = self.keys().collect();
        for (index, axis) in keys.iter().enumerate() {
            let set = self.set.iter().map(|(key, _)| key.as_str());
            let within = format!("{axis}.");
            let mut before = set.chain(keys[..index].iter().copied());
            if let Some(key) = before.find(|key| key.starts_with(&within)) {
                return Err(SweepError::Replaced {
                    path: self.path.clone(),
                    key: key.to_owned(),
                    axis: (*axis).to_owned(),
                });
            }
        }
        for (index, key) in keys.iter().enumerate() {
            let set = self.set.iter().position(|(set, _)| set == key);
            let place = match set {
                _ if keys[..index].contains(key) => "in an axis",
                Some(place) if place < own => "in [set]",
                Some(_) => "with --set",
                None => continue,
            };
            return Err(SweepError::Twice {
                path: self.path.clone(),
                key: (*key).to_owned(),
                place,
            });
        }
        Ok(())
    }

    fn check_folders(&self) -> Result<(), SweepError> {
        let Folders::Numbers(numbers) = &self.folders else {
            return Ok(());
        };
        let count = self.count();
        match numbers.iter().find(|case| !(1..=count).contains(*case)) {
            None => Ok(()),
            Some(case) => Err(SweepError::Folders {
                path: self.path.clone(),
                case: *case,
                count,
            }),
        }
    }

    fn check_plot(&self) -> Result<(), SweepError> {
        let keys: Vec<&str> = self.keys().collect();
        let wrong = |key, reason| SweepError::Plot {
            path: self.path.clone(),
            key,
            reason,
        };
        for (place, key) in [("x", &self.plot.x), ("series", &self.plot.series)] {
            if let Some(key) = key
                && !keys.contains(&key.as_str())
            {
                let reason = format!(
                    "{key} is not the key of an axis; these are: {}",
                    keys.join(", ")
                );
                return Err(wrong(place, reason));
            }
        }
        if let Some(key) = &self.plot.x
            && self.plot.series.as_ref() == Some(key)
        {
            let reason = format!("{key} is x already; take another axis, or leave series out");
            return Err(wrong("series", reason));
        }
        match &self.plot.y {
            Some(y) if !quantity_names().any(|name| name == *y) => {
                let names = quantity_names().collect::<Vec<_>>().join(", ");
                let reason = format!("{y} is not a quantity of a run; these are: {names}");
                Err(wrong("y", reason))
            }
            _ => Ok(()),
        }
    }

    /// Reads the scene with each value of each axis, the others at their first; returns the fingerprint.
    fn check_scenes(&self) -> Result<String, SweepError> {
        let mut files = BTreeMap::new();
        let mut indices: Vec<usize> = vec![0; self.axes.len()];
        let first = self.check_scene(&indices)?;
        add_files(&first, &mut files);
        for axis in 0..self.axes.len() {
            let mut seen = HashMap::from([(self.understood(axis, 0, &first), 0)]);
            for value in 1..self.axes[axis].values.len() {
                indices[axis] = value;
                let scene = self.check_scene(&indices)?;
                add_files(&scene, &mut files);
                if let Some(before) = seen.insert(self.understood(axis, value, &scene), value) {
                    return Err(self.repeated(axis, before, value));
                }
            }
            indices[axis] = 0;
        }
        let mut study = first.identity();
        // Neither changes what a finished case found.
        if let Some(scene) = study.as_object_mut() {
            scene.remove("title");
        }
        if let Some(solver) = study["solver"].as_object_mut() {
            solver.remove("max_iterations");
        }
        let axes = self.axes.iter();
        study["axis"] = axes
            .map(|axis| json!({ "keys": axis.keys, "values": axis.values }))
            .collect();
        // In the order of the files' paths, which depend on the folder of the call.
        study["checksums of files"] = files.into_values().collect();
        Ok(study.to_string())
    }

    /// A value of an axis as its scene understood it: texts of two are equal where the values are.
    fn understood(&self, axis: usize, value: usize, scene: &Scene) -> String {
        let Axis { keys, values } = &self.axes[axis];
        let resolved = scene.resolved_json();
        let each = keys.iter().zip(&values[value]);
        let each = each.map(|(key, text)| match value_at(&resolved, key) {
            Some(understood) if !understood.is_null() => understood.to_string(),
            // The resolved scene has another key in its place.
            _ => match written(text) {
                text if text.parse::<f64>().is_ok() => format!("{:?}", text.parse::<f64>()),
                text => text,
            },
        });
        each.collect::<Vec<_>>().join("\n")
    }

    /// Two values of an axis that are the same: their runs would count as independent ones in the means.
    fn repeated(&self, axis: usize, before: usize, value: usize) -> SweepError {
        let Axis { keys, values } = &self.axes[axis];
        let [before, again] = [before, value].map(|index| values[index].join(", "));
        let reason = if before == again {
            format!("{again} comes twice; leave one of them out")
        } else {
            format!("{again} is the same as {before}; leave one of them out")
        };
        SweepError::Axis {
            path: self.path.clone(),
            axis: axis + 1,
            key: keys.join(", "),
            reason,
        }
    }

    fn check_scene(&self, indices: &[usize]) -> Result<Scene, SweepError> {
        let mut case = Case {
            number: 0,
            settings: Vec::new(),
        };
        for (axis, index) in self.axes.iter().zip(indices) {
            let values = axis.values[*index].iter().cloned();
            case.settings.extend(axis.keys.iter().cloned().zip(values));
        }
        self.scene(&case).map_err(|errors| SweepError::Scene {
            path: self.path.clone(),
            reason: self.mistakes(&case, &errors),
        })
    }

    /// The mistakes of the scene of a case, one a line.
    pub(super) fn mistakes(&self, case: &Case, errors: &SceneErrors) -> String {
        let value = |key: &str| {
            let mut all = case.settings.iter().chain(&self.set);
            let found = all.find(|(known, _)| known == key);
            found.map_or_else(String::new, |(_, value)| format!("={value}"))
        };
        let lines = errors.0.iter().map(|mistake| match &mistake.error {
            error if mistake.from_set => format!("{}{}: {error}", mistake.key, value(&mistake.key)),
            SceneError::Unreadable { .. } | SceneError::Syntax { .. } => mistake.to_string(),
            _ => format!("{mistake} (with {})", case.words()),
        });
        lines.collect::<Vec<_>>().join("\n")
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

    /// The unit of a key in the tables: that of its values, or what the scene takes; empty where it has none.
    pub(super) fn unit(&self, key: &str) -> &'static str {
        let mut texts = self.axes.iter().flat_map(|axis| {
            let place = axis.keys.iter().position(|known| known == key);
            place.map(|place| axis.values[0][place].as_str())
        });
        let written = texts.next().unwrap_or_default().trim_matches('"');
        match parse_any_quantity(written) {
            Some((_, dimension)) => dimension.unit_in_scenes(),
            None => unit_of(key),
        }
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
            let stem = self.path.file_stem().unwrap_or_default();
            stem.to_string_lossy().into_owned()
        };
        self.title.clone().unwrap_or_else(stem)
    }

    /// Identifies the study.
    pub(super) fn fingerprint(&self) -> &str {
        &self.fingerprint
    }
}

/// Adds the settings of a table of `[set]`; tables within it are parts of a key.
fn flatten(before: &str, table: &toml::Table, set: &mut Vec<(String, String)>) {
    for (name, value) in table {
        let key = format!("{before}{name}");
        match value {
            toml::Value::Table(deeper) => flatten(&format!("{key}."), deeper, set),
            value => set.push((key, value.to_string())),
        }
    }
}

/// Adds the checksums of the files that a scene reads; one that cannot be read is a case's to report.
fn add_files(scene: &Scene, files: &mut BTreeMap<PathBuf, u32>) {
    for path in scene.files() {
        if !files.contains_key(path)
            && let Ok(bytes) = std::fs::read(path)
        {
            files.insert(path.to_path_buf(), crc32fast::hash(&bytes));
        }
    }
}

/// Whether a text that is no study is a scene.
fn is_scene(text: &str) -> bool {
    let table: Option<toml::Table> = text.parse().ok();
    table.is_some_and(|table| table.contains_key("grid") && !table.contains_key("axis"))
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
