//! What can go wrong with the files of a run.

use std::io;
use std::path::{Path, PathBuf};

/// The remedy for a run that cannot be resumed: following it never loses rows.
pub(crate) const FRESH: &str =
    "run without --resume to start afresh, which keeps the rows of curve.csv in curve.csv.before";

/// Why an output could not be written.
///
/// [`OutputError::Refused`] is a mistake in the call (exit status 2), everything else an output
/// that cannot be written (exit status 1).
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// Writing there would touch files that are not this run's.
    #[error("{}: {reason}", path.display())]
    Refused {
        /// The folder or file asked for.
        path: PathBuf,
        /// Why it is refused, and the way out.
        reason: String,
    },
    /// The system refused: disk full, no permission, ...
    #[error("cannot {action} {}: {cause}", path.display())]
    Write {
        /// What was being done, such as "write" or "create the folder".
        action: &'static str,
        /// The file or folder it was done to.
        path: PathBuf,
        /// What the system said.
        cause: io::Error,
    },
    /// A field to be drawn holds values that no colour can stand for.
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
    /// A failure of the system while doing `action` to `path`; for use with `map_err`.
    pub(crate) fn write(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_path_buf();
        move |cause| OutputError::Write {
            action,
            path,
            cause,
        }
    }

    /// A refusal of `path`.
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
