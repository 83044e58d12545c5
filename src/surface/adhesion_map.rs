//! The adhesion map: a factor on the law's tension at each point, from a pattern or a file.

use std::path::{Path, PathBuf};

use super::array;
use super::error::{FileError, PartError, SurfaceError};
use super::file;
use crate::grid::Grid;
use crate::scene::{AdhesionMap, Boundary, HeightFileScene, LawName, PatternKind, Scene};

/// Rounding tolerance of a point's position in a pattern, in half periods.
const ROUNDING: f64 = 1e-9;

/// What is wrong with an adhesion map.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// The file cannot be read as a map.
    #[error(transparent)]
    File(#[from] FileError),
    /// An array of another number of points than the grid.
    #[error(transparent)]
    Array(#[from] Box<PartError>),
    /// A factor that the law cannot take.
    #[error("row {row}, column {column}: a factor of {value:e}; {remedy}")]
    Factor {
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
        /// The number found.
        value: f64,
        /// What would do.
        remedy: &'static str,
    },
    /// A map without any attraction.
    #[error("every factor is 0; leave [adhesion] out, or take a map that attracts somewhere")]
    Nothing,
}

/// The adhesion map of a scene on its grid, shape `[ny, nx]`; `None` without a map.
pub(super) fn build(scene: &Scene, grid: &Grid) -> Result<Option<Vec<f64>>, SurfaceError> {
    let Some(adhesion) = &scene.adhesion else {
        return Ok(None);
    };
    let Some(map) = &adhesion.map else {
        return Ok(None);
    };
    let (path, factors) = match map {
        AdhesionMap::File(path) => (path.clone(), read(path, grid)),
        AdhesionMap::Factors(factors) => (
            PathBuf::from("array"),
            array::values(factors, grid)
                .map(<[f64]>::to_vec)
                .map_err(|problem| Box::new(problem).into()),
        ),
        AdhesionMap::Pattern {
            kind,
            period,
            low,
            high,
        } => (
            // The message shows this in place of a file name.
            PathBuf::from("pattern"),
            Ok(pattern(*kind, *period, [*low, *high], grid)),
        ),
    };
    factors
        .and_then(|factors| check(factors, adhesion.law, grid))
        .map(Some)
        .map_err(|problem| SurfaceError::AdhesionMap {
            path,
            problem: Box::new(problem),
        })
}

fn read(path: &Path, grid: &Grid) -> Result<Vec<f64>, MapError> {
    let plain = HeightFileScene::new(path);
    // A map need not be periodic, so mismatched edges are not reported.
    let map = match file::read_numbers(&plain, Boundary::Free) {
        // Grey images: black means no attraction, white the full law.
        Err(FileError::GreyEndsMissing) => file::read_numbers(
            &HeightFileScene {
                black: Some(0.0),
                white: Some(1.0),
                ..plain
            },
            Boundary::Free,
        ),
        map => map,
    }?;
    map.compare_points([grid.nx, grid.ny], "the grid")?;
    map.compare_size([grid.lx, grid.ly], "the grid")?;
    Ok(map.heights)
}

/// Low and high factors alternate every half period; the first point is high.
fn pattern(kind: PatternKind, period: f64, [low, high]: [f64; 2], grid: &Grid) -> Vec<f64> {
    // Parity by floating point: with periods far below a pixel no integer holds the count.
    let odd = |place: f64| (2.0 * (place / period) + ROUNDING).floor() % 2.0 != 0.0;
    let mut factors = Vec::with_capacity(grid.len());
    for row in 0..grid.ny {
        let odd_row = kind == PatternKind::Checker && odd(row as f64 * grid.dy());
        for column in 0..grid.nx {
            let low_here = odd(column as f64 * grid.dx()) != odd_row;
            factors.push(if low_here { low } else { high });
        }
    }
    factors
}

fn check(factors: Vec<f64>, law: LawName, grid: &Grid) -> Result<Vec<f64>, MapError> {
    let core = law == LawName::LennardJones;
    let wrong = |factor: f64| !factor.is_finite() || factor < 0.0 || (core && factor == 0.0);
    if let Some(point) = factors.iter().position(|&factor| wrong(factor)) {
        return Err(MapError::Factor {
            row: point / grid.nx + 1,
            column: point % grid.nx + 1,
            value: factors[point],
            remedy: if core {
                "it must be above 0: with law = \"lennard-jones\" the factor also multiplies the repulsion"
            } else {
                "it must be finite and at least 0"
            },
        });
    }
    if factors.iter().all(|&factor| factor == 0.0) {
        return Err(MapError::Nothing);
    }
    Ok(factors)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_start_high_and_repeat() {
        let grid = Grid::new([4, 4], [1.0, 1.0]);
        let checker = pattern(PatternKind::Checker, 1.0, [0.0, 2.0], &grid);
        assert_eq!(checker[..4], [2.0, 2.0, 0.0, 0.0]);
        assert_eq!(checker[8..12], [0.0, 0.0, 2.0, 2.0]);
        let stripe = pattern(PatternKind::Stripe, 0.5, [0.5, 1.0], &grid);
        assert!(stripe.chunks(4).all(|row| row == [1.0, 0.5, 1.0, 0.5]));
    }

    /// More half periods in a pixel than an integer holds: one factor each, no panic.
    #[test]
    fn periods_far_below_a_pixel() {
        let grid = Grid::new([4, 4], [1.0, 1.0]);
        for period in [1e-40, f64::MIN_POSITIVE] {
            let checker = pattern(PatternKind::Checker, period, [0.0, 2.0], &grid);
            assert_eq!(checker[0], 2.0);
            assert!(checker.iter().all(|factor| [0.0, 2.0].contains(factor)));
        }
    }
}
