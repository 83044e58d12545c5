//! Why a command did not end well, and with which exit status it ends.

use std::path::PathBuf;

use super::interrupts::INTERRUPTED;
use crate::accuracy::AccuracyError;
use crate::backend::BackendError;
#[cfg(feature = "mpi")]
use crate::backend::ranks::MpiError;
use crate::backend::ranks::RankError;
use crate::device::DeviceError;
use crate::fit::FitError;
use crate::output::OutputError;
use crate::run::{MemoryError, RunError};
use crate::scene::SceneErrors;
use crate::study::count_of_steps;
use crate::surface::SurfaceError;
use crate::sweep::SweepError;
use crate::theory::TheoryError;

/// Why a command did not end well.
#[derive(Debug, thiserror::Error)]
pub(super) enum Failure {
    #[error("{0}")]
    Scene(#[from] SceneErrors),
    #[error("{path}: {error}", path = path.display())]
    Surface { path: PathBuf, error: SurfaceError },
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error(transparent)]
    Backend(#[from] BackendError),
    #[error("{}", .0.in_words("--backend cpu"))]
    Device(#[from] DeviceError),
    #[error("{}", .0.in_words("--precision single"))]
    Memory(MemoryError),
    #[error("{0}")]
    Usage(String),
    #[error(
        "step {step} did not converge: residual {residual:.1e} after {iterations} iterations, asked {tolerance:.1e}; its row is written and marked; {remedy}"
    )]
    NotConverged {
        step: usize,
        residual: f64,
        iterations: usize,
        tolerance: f64,
        remedy: String,
    },
    #[error("interrupted after {}", count_of_steps(*finished, *steps))]
    Interrupted { finished: usize, steps: usize },
    #[error(
        "interrupted after {rows} settings, which are kept in {}", folder.display()
    )]
    InterruptedStudy { rows: usize, folder: PathBuf },
    #[error(
        "interrupted after {finished} of {cases} cases, which are kept in {}; the same command continues with the others", folder.display()
    )]
    InterruptedSweep {
        finished: usize,
        cases: usize,
        folder: PathBuf,
    },
    #[error("{failed} of {cases} cases did not end well; {} has the reasons", table.display())]
    FailedCases {
        failed: usize,
        cases: usize,
        table: PathBuf,
    },
    #[error(transparent)]
    Sweep(#[from] SweepError),
    #[error(transparent)]
    Accuracy(#[from] AccuracyError),
    #[error(transparent)]
    Fit(#[from] FitError),
    #[error(transparent)]
    Theory(#[from] TheoryError),
    #[error(transparent)]
    Rank(#[from] RankError),
    #[cfg(feature = "mpi")]
    #[error(transparent)]
    Mpi(#[from] MpiError),
    #[cfg(all(feature = "mpi", unix))]
    #[error("rank {rank} {cause}; finished steps are kept, and --resume continues after them")]
    KilledRank { rank: usize, cause: String },
    #[cfg(not(feature = "mpi"))]
    #[error(
        "a launcher has started {ranks} processes, and this build of tabor is without the feature `mpi`: each would solve the whole scene; build it with --features mpi, or start one process"
    )]
    Launched { ranks: usize },
    #[error("cannot print: {0}")]
    Print(std::io::Error),
}

impl From<MemoryError> for Failure {
    fn from(error: MemoryError) -> Self {
        match error {
            MemoryError::Cost(error) => Failure::Backend(error),
            other => Failure::Memory(other),
        }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Surface(error) => Failure::Surface {
                path: PathBuf::new(),
                error,
            },
            RunError::Memory(error) => error.into(),
            RunError::Device(error) => error.into(),
            RunError::Backend(error) => error.into(),
            RunError::Output(error) => error.into(),
            RunError::Rank(error) => Failure::Rank(error),
        }
    }
}

impl Failure {
    /// The exit status.
    pub(super) fn status(&self) -> u8 {
        match self {
            Failure::Output(OutputError::Refused { .. }) => 2,
            Failure::Output(_) | Failure::Print(_) | Failure::Rank(_) => 1,
            #[cfg(feature = "mpi")]
            Failure::Mpi(_) => 1,
            #[cfg(all(feature = "mpi", unix))]
            Failure::KilledRank { .. } => 1,
            #[cfg(not(feature = "mpi"))]
            Failure::Launched { .. } => 2,
            Failure::Scene(_) | Failure::Surface { .. } | Failure::Usage(_) => 2,
            Failure::Memory(_)
            | Failure::Device(DeviceError::Points { .. } | DeviceError::Limits { .. }) => 2,
            Failure::NotConverged { .. }
            | Failure::FailedCases { .. }
            | Failure::Theory(TheoryError::NotConverged { .. })
            | Failure::Fit(FitError::Theory(TheoryError::NotConverged { .. })) => 3,
            Failure::Theory(_) | Failure::Fit(_) => 2,
            Failure::Backend(_) | Failure::Device(_) => 4,
            Failure::Accuracy(AccuracyError::Output(OutputError::Refused { .. })) => 2,
            Failure::Accuracy(AccuracyError::Output(_)) => 1,
            Failure::Accuracy(_) => 2,
            Failure::Sweep(SweepError::Output(OutputError::Refused { .. })) => 2,
            Failure::Sweep(SweepError::Output(_)) => 1,
            Failure::Sweep(_) => 2,
            Failure::Interrupted { .. }
            | Failure::InterruptedStudy { .. }
            | Failure::InterruptedSweep { .. } => INTERRUPTED,
        }
    }
}
