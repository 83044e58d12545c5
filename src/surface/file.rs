//! Reads a height file and applies the scene's fill, unit, scale and detrending.

use super::error::FileError;
use super::matrix::{Matrix, Size};
use super::statistics::edge_jumps;
use super::{detrend, fill, formats, prepare, resample};
use crate::backend::{Shape, Share};
use crate::grid::Grid;
use crate::scene::{Boundary, Detrend, Edges, Fill, HeightFileScene};
use crate::units::in_range;

/// Relative difference up to which two sizes agree: files store few digits.
const SIZE_MARGIN: f64 = 1e-3;

/// A map is taken as not periodic if the jump between opposite edges exceeds this many times the
/// step between neighbours.
///
/// A single wave whose steepest flank lies on the edge reaches 1.4.
const EDGE_JUMP: f64 = 3.0;

/// Share of the rms height from which a plane through a map is a tilt.
const TILTED: f64 = 0.1;

/// Heights read from a file, ready to be added.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct HeightMap {
    /// Heights, m, shape `[ny, nx]`, row-major; of several processes the rows of this one.
    pub(super) heights: Vec<f64>,
    /// Points along x and y.
    pub(super) points: [usize; 2],
    /// Size along x and y, m, if the file states it.
    pub(super) size: Option<[f64; 2]>,
    /// Warnings for the user.
    pub(super) warnings: Vec<String>,
}

impl HeightMap {
    /// Repeats the one row of a profile.
    pub(super) fn repeat(&mut self, rows: usize) {
        self.heights = self.heights.repeat(rows);
        self.points[1] = rows;
    }

    /// Refuses a map whose number of points differs from `points` (x, y).
    pub(super) fn compare_points(
        &self,
        points: [usize; 2],
        against: &'static str,
    ) -> Result<(), FileError> {
        if self.points == points {
            return Ok(());
        }
        let [columns, rows] = self.points;
        Err(FileError::OtherPoints {
            columns,
            rows,
            against,
            points,
            hint: if [rows, columns] == points {
                "; rows of a file are y and columns x: transpose it, or swap the two numbers"
            } else {
                "; leave points out to take those of the file, or give the file resample = [nx, ny]"
            },
        })
    }

    /// Refuses a map whose size differs from `size` (x, y), m.
    pub(super) fn compare_size(
        &self,
        size: [f64; 2],
        against: &'static str,
    ) -> Result<(), FileError> {
        match self.size {
            Some(found) if (0..2).any(|i| (found[i] - size[i]).abs() > SIZE_MARGIN * size[i]) => {
                Err(FileError::OtherSize {
                    found,
                    against,
                    size,
                })
            }
            _ => Ok(()),
        }
    }
}

/// Reads the height map of a scene, of a file of at most so many points, and applies all that the scene asks of it.
///
/// # Errors
/// See [`FileError`]; a line scan is one unless the scene takes it as a profile, or its grid has the same `points`.
pub(super) fn read(
    scene: &HeightFileScene,
    boundary: Boundary,
    points: Option<[usize; 2]>,
    most: usize,
) -> Result<HeightMap, FileError> {
    check_factors(scene)?;
    let mut matrix = read_at_most(scene, most)?;
    if scene.preparation.profile {
        prepare::to_profile(&mut matrix)?;
    } else {
        expect_map(points, [matrix.columns, matrix.rows])?;
    }
    whole_heights_of(scene, boundary, matrix)
}

/// Refuses factors that leave nothing of the heights.
pub(super) fn check_factors(scene: &HeightFileScene) -> Result<(), FileError> {
    for (name, value) in [("unit", scene.unit), ("scale", scene.scale)] {
        if value == 0.0 || !in_range(value) {
            return Err(FileError::Factor { name, value });
        }
    }
    Ok(())
}

/// Refuses a line scan of so many points along x and y, unless the grid has the same.
pub(super) fn expect_map(grid: Option<[usize; 2]>, points: [usize; 2]) -> Result<(), FileError> {
    if grid == Some(points) {
        Ok(())
    } else {
        prepare::expect_map(points)
    }
}

/// Refuses more points along x and y than one of several processes holds.
pub(super) fn expect_at_most(most: usize, points: [usize; 2]) -> Result<(), FileError> {
    if points[0].saturating_mul(points[1]) > most {
        return Err(FileError::Whole {
            points: Some(points),
            length: 0,
        });
    }
    Ok(())
}

/// Reads a file of at most so many points.
fn read_at_most(scene: &HeightFileScene, most: usize) -> Result<Matrix, FileError> {
    let map = formats::open_map(&scene.path, most)?;
    expect_at_most(most, [map.columns, map.rows])?;
    map.read()
}

/// The same of numbers that need not be heights, where a single row is a map too.
pub(super) fn read_numbers(
    scene: &HeightFileScene,
    boundary: Boundary,
    most: usize,
) -> Result<HeightMap, FileError> {
    whole_heights_of(scene, boundary, read_at_most(scene, most)?)
}

fn whole_heights_of(
    scene: &HeightFileScene,
    boundary: Boundary,
    mut matrix: Matrix,
) -> Result<HeightMap, FileError> {
    if let Some(crop) = scene.preparation.crop {
        prepare::crop(&mut matrix, crop)?;
    }
    let share = Share::whole(Shape::whole(matrix.columns, matrix.rows));
    heights_of(scene, boundary, matrix, &share)
}

/// Heights of the rows that a process holds, of a matrix with these rows of its values. Of several processes the map is neither
/// mirrored nor resampled.
pub(super) fn heights_of(
    scene: &HeightFileScene,
    boundary: Boundary,
    matrix: Matrix,
    share: &Share,
) -> Result<HeightMap, FileError> {
    let asked = &scene.preparation;
    let (mut rows, mut columns) = (matrix.rows, matrix.columns);
    let unit = matrix.unit.unwrap_or(scene.unit);
    let [factor, zero] = factor_and_zero(&matrix, scene, unit)?;
    let mut heights = matrix.values;
    let mut warnings = matrix.warnings;
    fill_missing(&mut heights, share, scene.fill, boundary, &mut warnings)?;

    let is_periodic = boundary == Boundary::Periodic;
    if let Some(times) = asked.outliers {
        let found = prepare::remove_outliers(&mut heights, share, times, is_periodic)?;
        if found > 0 {
            warnings.push(format!(
                "{found} of {} points stand out of their neighbours by more than {times} standard deviations and are interpolated",
                rows * columns
            ));
        }
    }

    if unit != scene.unit && scene.unit != 1.0 {
        warnings.push(format!(
            "the file says that its numbers are in units of {unit:e} m, which is used in place of unit = {:e} m",
            scene.unit
        ));
    }
    for height in &mut heights {
        *height = *height * factor + zero;
    }
    let magnitude = |most: f64, height: &f64| most.max(height.abs());
    let largest = share.greatest(heights.iter().fold(0.0, magnitude));
    if !in_range(largest) {
        return Err(FileError::Extreme { largest });
    }
    detrend::detrend(&mut heights, share, scene.detrend);
    let mut size = matrix.size.map(|size| match size {
        Size::Metres(size) => size,
        Size::LikeHeights(size) => size.map(|side| side * unit.abs()),
    });
    let open_edges = edges(&heights, share);
    let mut closes = open_edges.is_empty();
    if !closes && matches!(scene.detrend, Detrend::None | Detrend::Mean) {
        let tilt = detrend::tilt(&heights, share);
        if tilt > TILTED {
            warnings.push(format!(
                "the map is tilted: a plane is {:.0} % of its rms height; detrend = \"plane\" takes it off",
                100.0 * tilt
            ));
        }
    }
    match asked.edges {
        Edges::None => {}
        Edges::Window => {
            prepare::window(&mut heights, share);
            closes = true;
        }
        Edges::Mirror => {
            let before = [columns, rows];
            (heights, [columns, rows]) = prepare::mirror(&heights, rows, columns);
            let longer = |side: f64, i: usize| side * ([columns, rows][i] / before[i]) as f64;
            size = size.map(|[x, y]| [longer(x, 0), longer(y, 1)]);
            closes = true;
        }
    }
    if let Some([nx, ny]) = asked.resample {
        let (from, points) = ([columns, rows], [nx, if asked.profile { 1 } else { ny }]);
        heights = if is_periodic && closes {
            resample::by_waves(&heights, from, points)
        } else {
            resample::by_cubics(&heights, from, points)
        };
        [columns, rows] = points;
    }
    if is_periodic && asked.edges == Edges::None {
        warnings.extend(match asked.resample {
            None => open_edges,
            Some(_) => edges(&heights, &Share::whole(Shape::whole(columns, rows))),
        });
    }
    Ok(HeightMap {
        heights,
        points: [columns, rows],
        size,
        warnings,
    })
}

/// The factor that turns the file's numbers into heights, and the height of 0.
fn factor_and_zero(
    matrix: &Matrix,
    scene: &HeightFileScene,
    unit: f64,
) -> Result<[f64; 2], FileError> {
    match (matrix.grey, scene.black.zip(scene.white)) {
        (false, None) if scene.black.or(scene.white).is_none() => Ok([unit * scene.scale, 0.0]),
        (false, _) => Err(FileError::GreyEndsUnused),
        (true, None) => Err(FileError::GreyEndsMissing),
        (true, Some((black, white))) if black == white => {
            Err(FileError::GreyEndsEqual { value: black })
        }
        (true, Some((black, white))) => Ok([(white - black) * scene.scale, black * scene.scale]),
    }
}

/// Fills missing pixels, or refuses them.
fn fill_missing(
    values: &mut [f64],
    share: &Share,
    fill: Fill,
    boundary: Boundary,
    warnings: &mut Vec<String>,
) -> Result<(), FileError> {
    let [columns, rows] = share.surface();
    let points = columns * rows;
    let missing = |value: &f64| !value.is_finite();
    let here = [
        values.iter().filter(|value| missing(value)).count(),
        values.iter().filter(|value| value.is_infinite()).count(),
    ];
    let [count, infinite] = share.counts(here);
    if count == 0 {
        return Ok(());
    }
    match fill {
        Fill::None => {
            let first = values
                .iter()
                .position(missing)
                .map_or(f64::INFINITY, |place| {
                    (share.surface_rows().start * columns + place) as f64
                });
            let first = share.least(first) as usize;
            Err(FileError::Missing {
                count,
                points,
                infinite,
                row: first / columns + 1,
                column: first % columns + 1,
            })
        }
        Fill::Interpolate if count == points => Err(FileError::AllMissing { points }),
        Fill::Interpolate => {
            fill::interpolate(values, share, boundary == Boundary::Periodic)?;
            warnings.push(format!(
                "{count} of {points} pixels ({:.2} %) were missing and are interpolated",
                100.0 * count as f64 / points as f64
            ));
            Ok(())
        }
    }
}

/// What is warned of a map whose opposite edges do not match.
fn edges(heights: &[f64], share: &Share) -> Vec<String> {
    let mut warnings = Vec::new();
    // Jumps are compared with steps of the same map, so lengths do not matter.
    let grid = Grid::new(share.surface(), [1.0, 1.0]);
    let jumps = edge_jumps(&grid, share, heights);
    let largest = heights.iter().fold(0.0_f64, |most, h| most.max(h.abs()));
    // Rounding of a detrended plane is not a jump.
    let noise = 1e-12 * share.greatest(largest);
    for (axis, (jump, step)) in ["x", "y"].into_iter().zip(jumps) {
        if jump > EDGE_JUMP * step && jump > noise {
            warnings.push(format!(
                "the edges across {axis} do not match: rms jump {jump:.3e} m against {step:.3e} m between \
                 neighbours; on a periodic grid this is a step in the surface (detrend = \"plane\", \
                 edges = \"window\" or \"mirror\", or boundary = \"free\")"
            ));
        }
    }
    warnings
}
