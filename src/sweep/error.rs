//! Why a study cannot be read or carried out.

use std::path::PathBuf;

use crate::output::OutputError;

/// Why a study cannot be read or carried out.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {reason}", path.display())]
    Unreadable {
        /// The study.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// The file is not a study.
    #[error("{}: not a study: {reason}", path.display())]
    Syntax {
        /// The study.
        path: PathBuf,
        /// Line and mistake.
        reason: String,
    },
    /// No axis.
    #[error("{}: there is no [[axis]]; add one with a key of the scene and its values, such as key = \"surface.0.seed\" and values = [1, 2, 3]", path.display())]
    NoAxis {
        /// The study.
        path: PathBuf,
    },
    /// An axis that gives no values.
    #[error("{}: axis {axis} ({key}): {reason}", path.display())]
    Axis {
        /// The study.
        path: PathBuf,
        /// Its number, from 1.
        axis: usize,
        /// Its keys.
        key: String,
        /// What is wrong, and how to mend it.
        reason: String,
    },
    /// A key that an axis changes and something else too.
    #[error("{}: {key} is the key of an axis, and given once more {place}; leave one of them out", path.display())]
    Twice {
        /// The study.
        path: PathBuf,
        /// The key.
        key: String,
        /// Where it is given besides.
        place: &'static str,
    },
    /// A key whose value an axis replaces, with all that it lies in.
    #[error("{}: {key} has no effect: {axis}, the key of an axis, replaces all that it lies in; leave one of them out, or put that axis first", path.display())]
    Replaced {
        /// The study.
        path: PathBuf,
        /// The key.
        key: String,
        /// The key of the axis.
        axis: String,
    },
    /// A key or value that the scene does not take.
    #[error("{}: {reason}", path.display())]
    Scene {
        /// The study.
        path: PathBuf,
        /// Every mistake of the scene, one a line, with the values of the axes.
        reason: String,
    },
    /// A key of `[plot]` that names nothing.
    #[error("{}: plot.{key}: {reason}", path.display())]
    Plot {
        /// The study.
        path: PathBuf,
        /// Its key.
        key: &'static str,
        /// What is wrong, and how to mend it.
        reason: String,
    },
    /// A case in `folders` that the study does not have.
    #[error("{}: folders: there is no case {case}; the study has {count}", path.display())]
    Folders {
        /// The study.
        path: PathBuf,
        /// The case.
        case: usize,
        /// The number of cases.
        count: usize,
    },
    /// Too many cases.
    #[error("{}: {count} cases are more than {most}; take fewer values, or several studies", path.display())]
    TooMany {
        /// The study.
        path: PathBuf,
        /// Its cases.
        count: u128,
        /// The most that a study may have.
        most: usize,
    },
    /// The folder cannot be written, or is not this study's.
    #[error(transparent)]
    Output(#[from] OutputError),
}
