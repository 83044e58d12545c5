//! Files that appear whole or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::error::OutputError;

/// End of the names under which files are written before they are renamed.
pub(super) const UNFINISHED: &str = ".tabor-unfinished";

/// The hidden file that becomes `path` once it is whole.
pub(crate) fn hidden_file(path: &Path) -> PathBuf {
    let mut name = std::ffi::OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(UNFINISHED);
    path.with_file_name(name)
}

/// Gives the file at `path` the first free name of `NAME.before`, `NAME.before2` and so on, which no run
/// removes, and returns it.
pub fn set_aside(path: &Path) -> Result<PathBuf, OutputError> {
    let named = |count: usize| {
        let mut name = path.as_os_str().to_owned();
        name.push(match count {
            1 => ".before".to_owned(),
            more => format!(".before{more}"),
        });
        PathBuf::from(name)
    };
    let free = (1..)
        .map(named)
        .find(|name| fs::symlink_metadata(name).is_err())
        .expect("names do not run out");
    crash_point();
    fs::rename(path, &free).map_err(OutputError::write("move away", path))?;
    Ok(free)
}

/// Where a kill would find a folder between two of its changes. Ends the process there if the environment asks
/// for it: `TABOR_TEST_CRASH`, for tests, is the number of changes that are still made.
#[cfg(feature = "fault-injection")]
pub(super) fn crash_point() {
    use std::sync::atomic::{AtomicU64, Ordering};
    static MADE: AtomicU64 = AtomicU64::new(0);
    let made = MADE.fetch_add(1, Ordering::Relaxed);
    let asked = std::env::var("TABOR_TEST_CRASH").unwrap_or_default();
    if asked.parse() == Ok(made) {
        std::process::abort();
    }
}

#[cfg(not(feature = "fault-injection"))]
pub(super) fn crash_point() {}

/// Writes `bytes` to `path` so that a reader finds the old file or the new one, never half of it.
///
/// Folders on the way are created. The bytes go to a hidden file beside it, are synced to the
/// disk, and take the name last.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    if !folder.as_os_str().is_empty() {
        fs::create_dir_all(folder).map_err(OutputError::write("create the folder", folder))?;
    }
    replace(path, |file| file.write_all(bytes))
}

/// Puts `content` into a hidden file of the folder, which then takes the name.
pub(super) fn replace(
    path: &Path,
    content: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), OutputError> {
    let hidden = hidden_file(path);
    let written = File::create(&hidden)
        .and_then(|file| {
            let mut file = BufWriter::new(file);
            content(&mut file)?;
            file.into_inner()
                .map_err(io::IntoInnerError::into_error)?
                .sync_all()
        })
        .and_then(|()| {
            crash_point();
            fs::rename(&hidden, path)
        });
    if written.is_err() {
        // Best effort: the failure to report is the first one.
        let _ = fs::remove_file(&hidden);
    }
    written.map_err(OutputError::write("write", path))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn touch(path: &Path) {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "x").unwrap();
    }

    #[test]
    fn renamed_files_replace_no_other() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("curve.csv");
        for name in ["curve.csv.before", "curve.csv.before2", "curve.csv.before3"] {
            touch(&path);
            assert_eq!(set_aside(&path).unwrap(), place.path().join(name));
        }
        assert!(set_aside(&path).is_err());
    }

    #[test]
    fn a_failed_write_leaves_no_trace() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("taken");
        touch(&path.join("inside"));
        // A folder that is not empty cannot be replaced by a file.
        let outcome = write_atomically(&path, b"new");
        assert!(matches!(outcome, Err(OutputError::Write { .. })));
        assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    }
}
