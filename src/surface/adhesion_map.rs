//! The adhesion map: a factor on the law's tension at each point, from a pattern or a file.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::array;
use super::by_rows::{Reading, with_ends};
use super::error::{FileError, PartError, SurfaceError};
use super::file;
use crate::backend::Share;
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

/// The adhesion map of a scene on its grid, shape `[ny, nx]`, of several processes the rows of this one; `None` without a
/// map.
pub(super) fn build(
    scene: &Scene,
    grid: &Grid,
    share: &dyn Fn(&Grid) -> Share,
) -> Result<Option<Vec<f64>>, SurfaceError> {
    let Some(adhesion) = &scene.adhesion else {
        return Ok(None);
    };
    let Some(map) = &adhesion.map else {
        return Ok(None);
    };
    let held = share(grid);
    let rows = held.surface_rows();
    let named = |path: &Path, problem: MapError| SurfaceError::AdhesionMap {
        path: path.to_path_buf(),
        problem: Box::new(problem),
    };
    let (path, factors) = match map {
        AdhesionMap::File(path) => {
            let wrong = |problem: FileError| named(path, problem.into());
            (path.clone(), read(path, grid, share, &wrong)?)
        }
        AdhesionMap::Factors(factors) => {
            let path = PathBuf::from("array");
            let all = array::values(factors, grid)
                .map_err(|problem| named(&path, Box::new(problem).into()))?;
            let own = all[rows.start * grid.nx..rows.end * grid.nx].to_vec();
            (path, own)
        }
        AdhesionMap::Pattern {
            kind,
            period,
            low,
            high,
        } => (
            // The message shows this in place of a file name.
            PathBuf::from("pattern"),
            pattern(*kind, *period, [*low, *high], grid, rows),
        ),
    };
    let checked = check(&factors, adhesion.law, grid, &held);
    if let Some(error) = held.failure() {
        return Err(error.into());
    }
    checked.map_err(|problem| named(&path, problem))?;
    Ok(Some(factors))
}

/// Of grey images black means no attraction, white the full law.
const SHADES: [f64; 2] = [0.0, 1.0];

/// The factors of a file.
fn read(
    path: &Path,
    grid: &Grid,
    share: &dyn Fn(&Grid) -> Share,
    wrong: &dyn Fn(FileError) -> SurfaceError,
) -> Result<Vec<f64>, SurfaceError> {
    let plain = HeightFileScene::new(path);
    // A map need not be periodic, so mismatched edges are not reported.
    let boundary = Boundary::Free;
    let whole = || match file::read_numbers(&plain, boundary) {
        Err(FileError::GreyEndsMissing) => file::read_numbers(&with_ends(&plain, SHADES), boundary),
        map => map,
    };
    let reading = Reading {
        scene: &plain,
        boundary,
        share: &|points| share(&Grid::new(points, [1.0; 2])),
        repeats: None,
        whole: &whole,
        shades: Some(SHADES),
        fits: &|_| Ok(()),
        wrong,
    };
    let map = reading.read()?;
    let points = map.compare_points([grid.nx, grid.ny], "the grid");
    points
        .and_then(|()| map.compare_size([grid.lx, grid.ly], "the grid"))
        .map_err(wrong)?;
    Ok(map.heights)
}

/// Low and high factors alternate every half period; the first point is high.
fn pattern(
    kind: PatternKind,
    period: f64,
    [low, high]: [f64; 2],
    grid: &Grid,
    rows: Range<usize>,
) -> Vec<f64> {
    // Parity by floating point: with periods far below a pixel no integer holds the count.
    let odd = |place: f64| (2.0 * (place / period) + ROUNDING).floor() % 2.0 != 0.0;
    let mut factors = Vec::with_capacity(rows.len() * grid.nx);
    for row in rows {
        let odd_row = kind == PatternKind::Checker && odd(row as f64 * grid.dy());
        for column in 0..grid.nx {
            let low_here = odd(column as f64 * grid.dx()) != odd_row;
            factors.push(if low_here { low } else { high });
        }
    }
    factors
}

fn check(factors: &[f64], law: LawName, grid: &Grid, share: &Share) -> Result<(), MapError> {
    let core = law == LawName::LennardJones;
    let wrong = |factor: f64| !factor.is_finite() || factor < 0.0 || (core && factor == 0.0);
    let first = share.surface_rows().start * grid.nx;
    let here = factors.iter().position(|&factor| wrong(factor));
    let point = share.least(here.map_or(f64::INFINITY, |point| (first + point) as f64));
    if point.is_finite() {
        let point = point as usize;
        // The first process that has a wrong one tells its value.
        let found = here.map_or([0.0; 2], |here| {
            let is_it = first + here == point;
            [f64::from(u8::from(is_it)), factors[here]]
        });
        let all = share.all(found);
        let values = all.as_deref().unwrap_or(&found).chunks_exact(2);
        let mut value = values.filter(|found| found[0] == 1.0).map(|found| found[1]);
        return Err(MapError::Factor {
            row: point / grid.nx + 1,
            column: point % grid.nx + 1,
            value: value.next().unwrap_or(f64::NAN),
            remedy: if core {
                "it must be above 0: with law = \"lennard-jones\" the factor also multiplies the repulsion"
            } else {
                "it must be finite and at least 0"
            },
        });
    }
    if !share.any(factors.iter().any(|&factor| factor != 0.0)) {
        return Err(MapError::Nothing);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_start_high_and_repeat() {
        let grid = Grid::new([4, 4], [1.0, 1.0]);
        let checker = pattern(PatternKind::Checker, 1.0, [0.0, 2.0], &grid, 0..4);
        assert_eq!(checker[..4], [2.0, 2.0, 0.0, 0.0]);
        assert_eq!(checker[8..12], [0.0, 0.0, 2.0, 2.0]);
        let stripe = pattern(PatternKind::Stripe, 0.5, [0.5, 1.0], &grid, 0..4);
        assert!(stripe.chunks(4).all(|row| row == [1.0, 0.5, 1.0, 0.5]));
    }

    /// More half periods in a pixel than an integer holds: one factor each, no panic.
    #[test]
    fn periods_far_below_a_pixel() {
        let grid = Grid::new([4, 4], [1.0, 1.0]);
        for period in [1e-40, f64::MIN_POSITIVE] {
            let checker = pattern(PatternKind::Checker, period, [0.0, 2.0], &grid, 0..4);
            assert_eq!(checker[0], 2.0);
            assert!(checker.iter().all(|factor| [0.0, 2.0].contains(factor)));
        }
    }
}
