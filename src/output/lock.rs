//! A lock on a folder that is being written, against a second writer.
//!
//! The system holds the lock for the process and releases it when the process ends, however it ends: there is none
//! to be left behind. The file names its holder, for the message to a second writer.

use std::fs::{File, TryLockError};
use std::io::{Read as _, Write as _};
use std::path::Path;

use super::error::OutputError;
use crate::clock::seconds_since_epoch;

/// Most bytes of a lock file that are read.
const LONGEST: u64 = 512;

/// A lock that is held until this is dropped.
#[derive(Debug)]
pub struct FolderLock {
    file: File,
    warning: Option<String>,
}

impl FolderLock {
    /// The lock file of a folder that has no place of its own for it.
    pub const HIDDEN: &str = ".tabor-lock";

    /// Takes the lock at `path`, a file in or below `folder`, which is there.
    ///
    /// Where the file system knows no locks the folder is not held, and [`warning`](FolderLock::warning) says so.
    ///
    /// # Errors
    /// Refused if another process holds it; the message names that process.
    pub fn take(path: &Path, folder: &Path) -> Result<FolderLock, OutputError> {
        let mut file = open(path, folder)?;
        let warning = match file.try_lock() {
            Ok(()) => None,
            Err(TryLockError::WouldBlock) => {
                let reason = format!(
                    "another run is writing it{}; wait for its end, or name another folder",
                    holder(&mut file)
                );
                return Err(OutputError::refused(folder, reason));
            }
            Err(TryLockError::Error(cause)) => Some(format!(
                "{} cannot be held against a second run ({cause}): two at once would spoil each other's files",
                folder.display()
            )),
        };
        // The lock holds with or without these words.
        let _ = file
            .set_len(0)
            .and_then(|()| file.write_all(own_words().as_bytes()));
        Ok(FolderLock { file, warning })
    }

    /// The same, but waits while another process holds it: for what is done in moments. A file system that knows no
    /// locks holds nobody up.
    ///
    /// # Errors
    /// A folder or a file that cannot be written.
    pub fn wait(path: &Path, folder: &Path) -> Result<FolderLock, OutputError> {
        let file = open(path, folder)?;
        let _ = file.lock();
        let warning = None;
        Ok(FolderLock { file, warning })
    }

    /// The warning if the folder is not locked.
    pub fn warning(&self) -> Option<&str> {
        self.warning.as_deref()
    }
}

impl Drop for FolderLock {
    /// Leaves an empty file: were it removed, a third process could lock a new one of its name while a
    /// second still waits with the old.
    fn drop(&mut self) {
        let _ = self.file.set_len(0);
    }
}

/// Opens the lock file of a folder; both are made where they are missing.
fn open(path: &Path, folder: &Path) -> Result<File, OutputError> {
    std::fs::create_dir_all(folder).map_err(OutputError::write("create the folder", folder))?;
    File::options()
        .read(true)
        .write(true)
        .create(true)
        .truncate(false)
        .open(path)
        .map_err(OutputError::write("write", path))
}

/// Process, moment and machine of this run.
fn own_words() -> String {
    let host = sysinfo::System::host_name().unwrap_or_default();
    format!("{} {} {host}\n", std::process::id(), seconds_since_epoch())
}

/// Who holds a lock, as the file says.
fn holder(file: &mut File) -> String {
    let mut text = String::new();
    // A file that cannot be read while it is locked names nobody.
    let read = file.take(LONGEST).read_to_string(&mut text);
    read.ok()
        .and_then(|_| in_words(&text, seconds_since_epoch()))
        .unwrap_or_default()
}

fn in_words(text: &str, now: u64) -> Option<String> {
    let mut words = text.trim_end().splitn(3, ' ');
    let process: u32 = words.next()?.parse().ok()?;
    let since: u64 = words.next()?.parse().ok()?;
    let host = match words.next() {
        None | Some("") => String::new(),
        Some(host) => format!(" on {host}"),
    };
    let time = match now.saturating_sub(since) {
        seconds @ 0..120 => format!("{seconds} s"),
        seconds @ 120..7200 => format!("{} min", seconds / 60),
        seconds => format!("{} h", seconds / 3600),
    };
    Some(format!(" (process {process}{host}, for {time})"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lock_holder_is_named() {
        let words = |text: &str| in_words(text, 10_000);
        let found = |text: &str| Some(text.to_owned());
        assert_eq!(
            words("42 9990 box\n"),
            found(" (process 42 on box, for 10 s)")
        );
        assert_eq!(words("42 9000 \n"), found(" (process 42, for 16 min)"));
        assert_eq!(words("42 0 box"), found(" (process 42 on box, for 2 h)"));
        // A clock set back.
        assert_eq!(words("42 20000"), found(" (process 42, for 0 s)"));
        for text in ["", "42", "x 1 box"] {
            assert_eq!(words(text), None);
        }
    }
}
