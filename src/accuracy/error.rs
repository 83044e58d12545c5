//! Reasons why accuracy cannot be measured.

use crate::output::OutputError;
use crate::surface::SurfaceError;

/// What helps where the time does not suffice.
const LONGER: &str = "a longer budget";

/// Why the accuracy of a scene cannot be measured.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AccuracyError {
    /// The surface cannot be built.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The surface cannot be refined or coarsened.
    #[error("{what} belongs to one grid; accuracy needs the same surface on several: {remedy}")]
    OneGrid {
        /// The part that belongs to one grid.
        what: &'static str,
        /// The remedy.
        remedy: &'static str,
    },
    /// Too few points for a coarser grid.
    #[error(
        "grid.points: {} x {} points leave no coarser grid to compare with; take at least {least} a side",
        points[0], points[1]
    )]
    TooCoarse {
        /// Points of the scene's grid, x first.
        points: [usize; 2],
        /// Fewest points a side.
        least: usize,
    },
    /// Not even the coarsest reference was solved.
    #[error(
        "no reference was solved: {reason}; give {LONGER}, a shorter path or more max_iterations"
    )]
    NoReference {
        /// Why the first solve ended.
        reason: String,
    },
    /// A table or a picture cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}
