//! The adhesion map: a factor on the law's tension at each point, from a pattern or a file.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::array;
use super::by_rows::{Reading, with_ends};
use super::error::{PartError, SurfaceError};
use super::file;
use super::file_error::FileError;
use crate::backend::Share;
use crate::grid::Grid;
use crate::scene::{AdhesionMap, Boundary, HeightFileScene, LawName, PatternKind, Scene};

/// Rounding tolerance of a point's position in a pattern, in half periods.
const ROUNDING: f64 = 1e-9;

/// What messages show of a pattern in place of a file name.
const PATTERN: &str = "pattern";

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
    /// Periods shorter than two pixels, which alias to longer ones.
    #[error(
        "period = {period:e} m along {axis} is shorter than two pixels of {pixel:e} m; take more points, or a longer period"
    )]
    PeriodTooShort {
        /// The axis.
        axis: &'static str,
        /// The period of the pattern, m.
        period: f64,
        /// The grid spacing along the axis, m.
        pixel: f64,
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
            let wrong = |problem: FileError| named(path, of_file(problem));
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
        } => {
            check_period(*kind, *period, grid)?;
            let factors = pattern(*kind, *period, [*low, *high], grid, rows);
            (PathBuf::from(PATTERN), factors)
        }
    };
    let checked = check(&factors, adhesion.law, grid, &held);
    if let Some(error) = held.failure() {
        return Err(error.into());
    }
    checked.map_err(|problem| named(&path, problem))?;
    Ok(Some(factors))
}

/// What to do with a map of other points.
const EACH_POINT: &str = "; a map has a factor for each point of the grid";

/// What a factor must be.
const ALLOWED: &str = "it must be finite and at least 0";

/// A missing factor is a wrong one: there is nothing to fill it from.
fn of_file(problem: FileError) -> MapError {
    match problem {
        FileError::Missing { row, column, .. } => MapError::Factor {
            row,
            column,
            value: f64::NAN,
            remedy: ALLOWED,
        },
        other => other.into(),
    }
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
    let whole = || match file::read_factors(&plain, boundary) {
        Err(FileError::GreyEndsMissing) => file::read_factors(&with_ends(&plain, SHADES), boundary),
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
    let points = map.compare_points([grid.nx, grid.ny], "the grid", EACH_POINT);
    points
        .and_then(|()| map.compare_size([grid.lx, grid.ly], "the grid", false))
        .map_err(wrong)?;
    Ok(map.heights)
}

/// Refuses a pattern that alternates faster than the pixels.
pub(super) fn check_period(
    kind: PatternKind,
    period: f64,
    grid: &Grid,
) -> Result<(), SurfaceError> {
    let [x, y] = [("x", grid.dx()), ("y", grid.dy())];
    let axes = match kind {
        PatternKind::Checker => vec![x, y],
        PatternKind::Stripe => vec![x],
    };
    let too_short = |(_, pixel): &(_, f64)| period < 2.0 * pixel * (1.0 - ROUNDING);
    match axes.into_iter().find(too_short) {
        None => Ok(()),
        Some((axis, pixel)) => Err(SurfaceError::AdhesionMap {
            path: PathBuf::from(PATTERN),
            problem: Box::new(MapError::PeriodTooShort {
                axis,
                period,
                pixel,
            }),
        }),
    }
}

/// Share of the points of a grid that have the low factor of a pattern.
pub(super) fn low_share(kind: PatternKind, period: f64, grid: &Grid) -> f64 {
    let share = |points: usize, pixel: f64| {
        let odd = (0..points).filter(|i| is_odd(*i as f64 * pixel, period));
        odd.count() as f64 / points as f64
    };
    let along_x = share(grid.nx, grid.dx());
    match kind {
        PatternKind::Stripe => along_x,
        PatternKind::Checker => {
            let along_y = share(grid.ny, grid.dy());
            along_x * (1.0 - along_y) + (1.0 - along_x) * along_y
        }
    }
}

/// Whether a place lies in an odd half period, counted from 0.
fn is_odd(place: f64, period: f64) -> bool {
    (2.0 * (place / period) + ROUNDING).floor() % 2.0 != 0.0
}

/// Low and high factors alternate every half period; the first point is high.
fn pattern(
    kind: PatternKind,
    period: f64,
    [low, high]: [f64; 2],
    grid: &Grid,
    rows: Range<usize>,
) -> Vec<f64> {
    let odd = |place: f64| is_odd(place, period);
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
                ALLOWED
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

    /// Three pixels a period: two high, one low; what an outline says without the factors is their mean.
    #[test]
    fn the_share_of_the_low_factor_is_that_of_the_points() {
        for (points, period) in [([12, 9], 3.0), ([16, 8], 4.0), ([10, 7], 2.6)] {
            let grid = Grid::new(points, points.map(|points| points as f64));
            for kind in [PatternKind::Stripe, PatternKind::Checker] {
                check_period(kind, period, &grid).expect("two pixels");
                let factors = pattern(kind, period, [0.0, 1.0], &grid, 0..grid.ny);
                let mean = factors.iter().sum::<f64>() / grid.len() as f64;
                let low = low_share(kind, period, &grid);
                assert!((1.0 - low - mean).abs() < 1e-12, "{points:?} {low} {mean}");
            }
        }
    }

    #[test]
    fn periods_below_two_pixels_are_refused() {
        let grid = Grid::new([4, 8], [1.0, 1.0]);
        let refused = |kind, period| {
            let checked = check_period(kind, period, &grid);
            checked.map_err(|error| error.to_string()).err()
        };
        for period in [0.5, 0.5 - 1e-12] {
            assert_eq!(refused(PatternKind::Checker, period), None);
        }
        for period in [0.49, 0.25, 1e-40, f64::MIN_POSITIVE] {
            let message = refused(PatternKind::Stripe, period).expect("refused");
            assert!(
                message.contains("along x is shorter than two pixels"),
                "{message}"
            );
        }
    }
}
