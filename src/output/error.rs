//! Errors of the files of a run.

use std::io;
use std::path::{Path, PathBuf};

/// The remedy for a run that cannot be resumed; it never loses rows.
pub(crate) const FRESH: &str =
    "run without resuming to start afresh, which keeps the rows of curve.csv in curve.csv.before";

/// Why an output was not written.
///
/// [`OutputError::Refused`] is a mistake in the call (exit status 2); every other variant is an
/// output that cannot be written (exit status 1).
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The target contains files that do not belong to this run.
    #[error("{}: {reason}", path.display())]
    Refused {
        /// The folder or file asked for.
        path: PathBuf,
        /// The reason and the remedy.
        reason: String,
    },
    /// The system refused: disk full, no permission, ...
    #[error("cannot {action} {}: {cause}", path.display())]
    Write {
        /// The action, such as "write" or "create the folder".
        action: &'static str,
        /// The file or folder concerned.
        path: PathBuf,
        /// The system's message.
        cause: io::Error,
    },
    /// A field with non-finite values cannot be drawn.
    #[error("cannot draw the {field}: {count} of {points} points are not finite numbers")]
    NotFinite {
        /// Name of the field.
        field: &'static str,
        /// How many points are NaN or infinite.
        count: usize,
        /// How many points there are.
        points: usize,
    },
}

impl OutputError {
    /// Wraps a system error of `action` on `path`; for use with `map_err`.
    pub(crate) fn write(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_path_buf();
        move |cause| OutputError::Write {
            action,
            path,
            cause,
        }
    }

    /// Refuses `path`.
    pub(crate) fn refused(path: &Path, reason: impl Into<String>) -> Self {
        OutputError::Refused {
            path: path.to_path_buf(),
            reason: reason.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_the_path_and_the_cause() {
        let full = io::Error::from(io::ErrorKind::StorageFull);
        let message = OutputError::write("write", Path::new("out/curve.csv"))(full).to_string();
        assert!(
            message.starts_with("cannot write out/curve.csv: "),
            "{message}"
        );
        let refusal = OutputError::refused(Path::new("out"), "holds other files");
        assert_eq!(refusal.to_string(), "out: holds other files");
    }
}
