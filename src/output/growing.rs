//! A table that grows on the disk by whole lines and is restored if another program changes it.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use super::error::OutputError;
use super::folder::write_within;
use super::whole_file::set_aside;

/// A file that grows by whole lines, with its text in memory.
#[derive(Debug)]
pub struct GrowingTable {
    path: PathBuf,
    file: File,
    text: String,
}

impl GrowingTable {
    /// Creates or replaces the file at `path`, in one piece, with this text.
    pub fn create(path: &Path, text: String) -> Result<GrowingTable, OutputError> {
        Ok(GrowingTable {
            path: path.to_path_buf(),
            file: written(path, &text)?,
            text,
        })
    }

    /// Appends a line, with its end, and waits until it is on the disk.
    pub fn append(&mut self, line: &str) -> Result<(), OutputError> {
        self.hand_over(line)?;
        self.sync()
    }

    /// Appends a line, with its end, and leaves it to the system, which keeps it if this process dies; if the machine
    /// fails, what was appended since the last [`sync`](Self::sync) may be lost.
    pub fn hand_over(&mut self, line: &str) -> Result<(), OutputError> {
        // One write a line, so that a reader or a crash meets whole ones.
        self.file
            .write_all(line.as_bytes())
            .map_err(OutputError::write("write", &self.path))?;
        self.text.push_str(line);
        Ok(())
    }

    /// Waits until every line is on the disk.
    pub fn sync(&self) -> Result<(), OutputError> {
        self.file
            .sync_data()
            .map_err(OutputError::write("write", &self.path))
    }

    /// Writes the file again from memory if it was removed, replaced, or has another length; with `whole` its
    /// content is compared too. Returns a description of the change, if any.
    pub fn restore(&mut self, whole: bool) -> Result<Option<String>, OutputError> {
        let here = match fs::metadata(&self.path) {
            Ok(found) => Some(found),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(OutputError::write("read", &self.path)(error)),
        };
        let found = match here {
            None => "was removed while the run was active; its rows are written again".to_owned(),
            Some(here) => {
                let same = here.len() == self.text.len() as u64
                    && is_one_file(&here, &self.file)
                    && (!whole || self.content()? == self.text.as_bytes());
                if same {
                    return Ok(None);
                }
                format!(
                    "was changed by another program while the run was active; its rows are written again, and the changed file is kept as {}",
                    set_aside(&self.path)?.display()
                )
            }
        };
        self.file = written(&self.path, &self.text)?;
        Ok(Some(format!("{} {found}", self.path.display())))
    }

    fn content(&self) -> Result<Vec<u8>, OutputError> {
        fs::read(&self.path).map_err(OutputError::write("read", &self.path))
    }
}

/// Writes a file in one piece and opens it for further lines.
fn written(path: &Path, text: &str) -> Result<File, OutputError> {
    write_within(path, text.as_bytes())?;
    OpenOptions::new()
        .append(true)
        .open(path)
        .map_err(OutputError::write("open", path))
}

/// Whether the file found under a name is the open one.
#[cfg(unix)]
fn is_one_file(found: &fs::Metadata, open: &File) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |data: &fs::Metadata| (data.dev(), data.ino());
    // If the system does not tell, the file counts as the same.
    open.metadata()
        .map_or(true, |open| place(&open) == place(found))
}

/// Elsewhere an open file keeps its name.
#[cfg(not(unix))]
fn is_one_file(_: &fs::Metadata, _: &File) -> bool {
    true
}
