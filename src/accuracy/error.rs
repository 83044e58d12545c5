//! What keeps a scene from being judged.

use crate::output::OutputError;
use crate::surface::SurfaceError;

/// Why accuracy cannot be measured.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AccuracyError {
    /// The surface cannot be built.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The scene has no finer and no coarser grid of the same surface.
    #[error("{what} belongs to one grid; accuracy needs the same surface on several: {remedy}")]
    OneGrid {
        /// What is bound to its grid.
        what: &'static str,
        /// The way out.
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
        "no reference was solved: {reason}; give a longer --budget, a shorter path or max_iterations to spare"
    )]
    NoReference {
        /// What ended the first solve.
        reason: String,
    },
    /// A table or a picture cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}
