//! Whether the memory holds the statistics of a surface.

use std::path::Path;

use crate::run::MemoryError;
use crate::run::memory_check::{available, check_file, check_map_of, count};
use crate::scene::Boundary;
use crate::surface::MOST_POINTS;

/// Bytes of a complex number.
const COMPLEX: u64 = 16;

/// Refuses a height file whose statistics need more memory than there is, where its header tells.
pub(super) fn check_map(path: &Path, boundary: Boundary) -> Result<(), MemoryError> {
    check_file(path, |points| statistics(points, boundary))
}

/// Refuses the statistics of `points` of the surface that `path` describes.
pub(super) fn check_statistics(
    path: &Path,
    points: [usize; 2],
    boundary: Boundary,
) -> Result<(), MemoryError> {
    match available()? {
        // Counts past all grids are the surface's to refuse.
        Some(available) if points[0].saturating_mul(points[1]) <= MOST_POINTS => {
            check_map_of(path, points, statistics(points, boundary), available)
        }
        _ => Ok(()),
    }
}

/// Bytes that the statistics of a surface take, at most [`MOST_POINTS`]: the heights, and the
/// autocorrelation's field with two half spectra, on a free grid of half as many points again a side. A
/// transform has its table and a line for each thread.
fn statistics(points: [usize; 2], boundary: Boundary) -> u64 {
    let padded = match boundary {
        Boundary::Periodic => points,
        Boundary::Free => points.map(|side| side + side.div_ceil(2)),
    };
    let half = [padded[0] / 2 + 1, padded[1]];
    let threads = std::thread::available_parallelism().map_or(1, |count| count.get() as u64);
    let line = COMPLEX * padded[0].max(padded[1]) as u64;
    8 * count(points) + 8 * count(padded) + 2 * COMPLEX * count(half) + (2 + threads) * line
}
