//! The folder of a run: who may write where.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::difference::difference;
use super::error::OutputError;
use super::lock::FolderLock;
use super::whole_file::{UNFINISHED, crash_point, replace, write_atomically};
use crate::scene::FieldName;

/// Folders within that of a run.
const PARTS: [&str; 3] = ["images", "fields", "state"];

/// Files that a run writes at the top of its folder.
const TOP_FILES: [&str; 5] = [
    "curve.csv",
    "curve.png",
    "curve.svg",
    "summary.json",
    "report.html",
];

/// Prefix of the files of the state after the last step.
const STATE_PREFIX: &str = "last_";

/// The file that says that tabor wrote this folder, and for which scene.
const MARKER: &str = "scene.json";

/// The file in `state` that a run holds while it writes the folder. It stays when the run ends, empty.
const LOCK: &str = "lock";

/// Content of `state/scene.json`.
#[derive(Debug, Serialize, Deserialize)]
struct Marker {
    /// Version of tabor that opened the folder.
    tabor: String,
    /// Identifies the scene, as the caller made it.
    fingerprint: String,
}

/// The folder that one run of one scene writes. It is locked against other runs until the last copy of this
/// value is dropped or the process ends.
#[derive(Clone, Debug)]
pub struct RunFolder {
    path: PathBuf,
    lock: Arc<FolderLock>,
}

impl RunFolder {
    /// Opens `path` for a run from its first step, creating it where it is missing.
    ///
    /// A folder with files in it is taken only if tabor wrote it for the scene of this
    /// `fingerprint`; then the files of that run are removed and no others.
    pub fn open(path: &Path, fingerprint: &str) -> Result<RunFolder, OutputError> {
        let (folder, there) = RunFolder::take(path, fingerprint)?;
        if there {
            folder.remove_own_files(&[])?;
        }
        folder.write_marker(fingerprint)?;
        Ok(folder)
    }

    /// Holds the folder at `path`, which is created where it is missing, and says whether a run of this
    /// `fingerprint` is in it. Nothing in it is changed.
    ///
    /// # Errors
    /// Refused where another run holds it, or where it has files in it and tabor did not write them for the
    /// scene of this `fingerprint`; then it is left untouched.
    pub fn take(path: &Path, fingerprint: &str) -> Result<(RunFolder, bool), OutputError> {
        let path = here_if_empty(path);
        let inside = Inside { path: &path };
        if !inside.is_empty()? {
            inside.expect_marker(fingerprint)?;
        }
        let state = path.join("state");
        fs::create_dir_all(&state).map_err(OutputError::write("create the folder", &state))?;
        let lock = FolderLock::take(&state.join(LOCK), &path)?;
        // Another run may have begun and ended since the look before.
        let there = !inside.is_empty()?;
        if there {
            inside.expect_marker(fingerprint)?;
        }
        let lock = Arc::new(lock);
        Ok((RunFolder { path, lock }, there))
    }

    /// The warning of a folder that cannot be locked.
    pub fn warning(&self) -> Option<&str> {
        self.lock.warning()
    }

    /// Opens `path` to resume the run that it holds; says whether there is one. Results stay,
    /// files that were being written when the run ended go.
    ///
    /// A folder that is missing or empty is opened for a run from its first step; one that tabor
    /// did not write for the scene of this `fingerprint` is refused.
    pub fn resume(path: &Path, fingerprint: &str) -> Result<(RunFolder, bool), OutputError> {
        let (folder, there) = RunFolder::take(path, fingerprint)?;
        if !there {
            folder.write_marker(fingerprint)?;
            return Ok((folder, false));
        }
        for part in [""].into_iter().chain(PARTS) {
            remove_files(&folder.path.join(part), |name, unfinished| {
                unfinished && !name.is_empty()
            })?;
        }
        Ok((folder, true))
    }

    /// Fails if the folder was removed, so that no half of it is created again.
    pub fn expect_present(&self) -> Result<(), OutputError> {
        match fs::metadata(marker_path(&self.path)) {
            Ok(_) => Ok(()),
            Err(error) => Err(OutputError::write("find the folder", &self.path)(error)),
        }
    }

    /// Removes the pictures and fields of the steps that `own` picks.
    pub fn remove_steps(&self, own: impl Fn(usize) -> bool) -> Result<(), OutputError> {
        for part in ["images", "fields"] {
            remove_files(&self.path.join(part), |name, _| {
                step_of(name).is_some_and(&own)
            })?;
        }
        Ok(())
    }

    /// The pictures that there are: step, name of the field and file, in the order of steps.
    pub fn pictures(&self) -> Vec<(usize, &'static str, PathBuf)> {
        let found = files_of_fields(&self.path.join("images"), ".png").into_iter();
        found
            .map(|(step, field, path)| (step, field.name(), path))
            .collect()
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// `curve.csv`.
    pub fn curve_path(&self) -> PathBuf {
        self.path.join("curve.csv")
    }

    /// `summary.json`.
    pub fn summary_path(&self) -> PathBuf {
        self.path.join("summary.json")
    }

    /// `report.html`.
    pub fn report_path(&self) -> PathBuf {
        self.path.join("report.html")
    }

    /// The picture of a field at a step, such as `images/step_0003_pressure.png`.
    pub fn image_path(&self, step: usize, field: FieldName) -> PathBuf {
        self.path
            .join("images")
            .join(format!("step_{step:04}_{}.png", field.name()))
    }

    /// The values of a field at a step, such as `fields/step_0003_pressure.npy`.
    pub fn field_path(&self, step: usize, field: FieldName) -> PathBuf {
        self.path
            .join("fields")
            .join(format!("step_{step:04}_{}.npy", field.name()))
    }

    /// `curve.png`.
    pub fn curve_picture_path(&self) -> PathBuf {
        self.path.join("curve.png")
    }

    /// `curve.svg`.
    pub fn curve_vector_path(&self) -> PathBuf {
        self.path.join("curve.svg")
    }

    /// The fields of a step for ParaView, such as `fields/step_0003.vti`.
    pub fn volume_path(&self, step: usize) -> PathBuf {
        self.path.join("fields").join(format!("step_{step:04}.vti"))
    }

    /// A file of the state after the last step: `state/last_NAME`.
    ///
    /// The prefix marks it as tabor's own, to be removed when the run starts afresh.
    pub fn state_path(&self, name: &str) -> PathBuf {
        self.path
            .join("state")
            .join(format!("{STATE_PREFIX}{name}"))
    }

    /// Marks the folder as that of a run of this `fingerprint`.
    pub fn write_marker(&self, fingerprint: &str) -> Result<(), OutputError> {
        let marker = Marker {
            tabor: env!("CARGO_PKG_VERSION").to_owned(),
            fingerprint: fingerprint.to_owned(),
        };
        let mut text = serde_json::to_string_pretty(&marker)
            .expect("two strings can always be written as JSON");
        text.push('\n');
        write_atomically(&marker_path(&self.path), text.as_bytes())
    }

    /// Removes what a run writes, but for the files `kept`: known names only, so that a note left beside them
    /// stays.
    pub fn remove_own_files(&self, kept: &[&Path]) -> Result<(), OutputError> {
        let remove = |folder: &Path, own: &dyn Fn(&str) -> bool| {
            remove_files(folder, |name, unfinished| {
                own(name) && (unfinished || !kept.contains(&folder.join(name).as_path()))
            })
        };
        remove(&self.path, &|name| TOP_FILES.contains(&name))?;
        self.remove_steps(|_| true)?;
        // The marker stays until it is replaced: a run that ends in between is still recognised.
        remove(&self.path.join("state"), &|name| {
            name.starts_with(STATE_PREFIX)
        })
    }
}

/// A folder that is looked at before it is held.
struct Inside<'a> {
    path: &'a Path,
}

impl Inside<'_> {
    /// Whether there is nothing in the folder, or no folder. One in which a run ended before it had
    /// left its marker holds nothing either.
    fn is_empty(&self) -> Result<bool, OutputError> {
        let names = |folder: &Path| -> io::Result<Vec<std::ffi::OsString>> {
            fs::read_dir(folder)?
                .take(3)
                .map(|entry| Ok(entry?.file_name()))
                .collect()
        };
        match names(self.path) {
            Ok(found) if found == ["state"] => {
                let unfinished = format!(".{MARKER}{UNFINISHED}");
                let inside = names(&self.path.join("state")).unwrap_or_default();
                Ok(inside
                    .iter()
                    .all(|name| name == LOCK || *name == unfinished.as_str()))
            }
            Ok(found) => Ok(found.is_empty()),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(true),
            Err(error) if error.kind() == io::ErrorKind::NotADirectory => {
                Err(OutputError::refused(self.path, "is a file; name a folder"))
            }
            Err(error) => Err(OutputError::write("read the folder", self.path)(error)),
        }
    }

    fn expect_marker(&self, fingerprint: &str) -> Result<(), OutputError> {
        let path = marker_path(self.path);
        let marker = match fs::read(&path) {
            Ok(bytes) => serde_json::from_slice::<Marker>(&bytes).ok(),
            Err(error) if error.kind() == io::ErrorKind::PermissionDenied => {
                return Err(OutputError::write("read", &path)(error));
            }
            Err(_) => None,
        };
        match marker {
            None => Err(OutputError::refused(
                self.path,
                "holds files that tabor did not write (state/scene.json is not there or damaged); name an empty or new folder",
            )),
            Some(marker) if marker.fingerprint != fingerprint => Err(OutputError::refused(
                self.path,
                format!(
                    "holds the results of another scene{}; name another folder, or move this one away",
                    difference(&marker.fingerprint, fingerprint)
                ),
            )),
            Some(_) => Ok(()),
        }
    }
}

/// An empty path joins like the current folder but cannot be listed like it.
fn here_if_empty(path: &Path) -> PathBuf {
    let here = path.as_os_str().is_empty();
    if here { Path::new(".") } else { path }.to_path_buf()
}

fn marker_path(folder: &Path) -> PathBuf {
    folder.join("state").join(MARKER)
}

/// The step of `step_DIGITS_FIELD.png`, `step_DIGITS_FIELD.npy` or `step_DIGITS.vti`.
fn step_of(name: &str) -> Option<usize> {
    let (stem, extension) = name.rsplit_once('.')?;
    let (step, field) = step_and_field(stem)?;
    let fits = match extension {
        "vti" => field.is_none(),
        "png" | "npy" => field.is_some(),
        _ => false,
    };
    fits.then_some(step)
}

/// The files of a folder that hold a field of a step, such as `step_0003_pressure.npy`: step, field and file, in the
/// order of steps.
pub(crate) fn files_of_fields(folder: &Path, extension: &str) -> Vec<(usize, FieldName, PathBuf)> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let mut found: Vec<(usize, usize, PathBuf)> = entries
        .flatten()
        .filter_map(|entry| {
            let name = entry.file_name();
            let (step, field) = step_and_field(name.to_str()?.strip_suffix(extension)?)?;
            Some((step, field?, entry.path()))
        })
        .collect();
    found.sort();
    found
        .into_iter()
        .map(|(step, field, path)| (step, FieldName::ALL[field], path))
        .collect()
}

/// The step and the index of the field in `step_DIGITS_FIELD` or `step_DIGITS`.
fn step_and_field(stem: &str) -> Option<(usize, Option<usize>)> {
    let rest = stem.strip_prefix("step_")?;
    let (digits, field) = match rest.split_once('_') {
        None => (rest, None),
        Some((digits, word)) => {
            let mut names = FieldName::ALL.iter().map(|field| field.name());
            (digits, Some(names.position(|name| name == word)?))
        }
    };
    let is_number = digits.len() >= 4 && digits.bytes().all(|byte| byte.is_ascii_digit());
    digits
        .parse()
        .ok()
        .filter(|_| is_number)
        .map(|step| (step, field))
}

/// Removes the files of `folder` that `own` picks by their name and by whether they were being
/// written when a run ended.
fn remove_files(folder: &Path, own: impl Fn(&str, bool) -> bool) -> Result<(), OutputError> {
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(OutputError::write("read the folder", folder)(error)),
    };
    for entry in entries {
        let entry = entry.map_err(OutputError::write("read the folder", folder))?;
        let name = entry.file_name();
        let Some(name) = name.to_str() else { continue };
        let unfinished = name
            .strip_suffix(UNFINISHED)
            .and_then(|name| name.strip_prefix('.'));
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        if own(unfinished.unwrap_or(name), unfinished.is_some()) && !is_folder {
            let path = entry.path();
            crash_point();
            fs::remove_file(&path).map_err(OutputError::write("remove", &path))?;
        }
    }
    Ok(())
}

/// As [`write_atomically`] into the folder of a run, which is there or was taken away: only a folder
/// within it is created, so that no half of a run is created again.
pub fn write_within(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    stream_within(path, |file| file.write_all(bytes))
}

/// The same of what `content` writes, piece by piece.
pub fn stream_within(
    path: &Path,
    content: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), OutputError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let within = folder.file_name().and_then(|name| name.to_str());
    if within.is_some_and(|name| PARTS.contains(&name)) {
        match fs::create_dir(folder) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
                return Err(OutputError::write("create the folder", folder)(error));
            }
            _ => {}
        }
    }
    replace(path, content)
}

#[cfg(test)]
#[path = "folder_tests.rs"]
mod tests;
