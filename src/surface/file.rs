//! Reads a height file and applies the scene's fill, unit, scale and detrending.

use super::file_error::FileError;
use super::formats::Opening;
use super::matrix::{Matrix, Size};
use super::statistics::edge_jumps;
use super::{MOST_POINTS, detrend, fill, formats, outliers, prepare, profile, resample};
use crate::backend::{BackendError, Shape, Share};
use crate::grid::Grid;
use crate::scene::{Boundary, Detrend, Edges, Fill, HeightFileScene};
use crate::units::{format_si, in_range};

/// Relative difference up to which two sizes agree: files store few digits.
const SIZE_MARGIN: f64 = 1e-3;

/// A map is taken as not periodic if the jump between opposite edges exceeds this many times the
/// step between neighbours.
///
/// A single wave whose steepest flank lies on the edge reaches 1.4.
const EDGE_JUMP: f64 = 3.0;

/// Share of the rms height from which a plane through a map is a tilt.
const TILTED: f64 = 0.1;

/// What to do with heights of other points.
pub(super) const OTHER_POINTS: &str =
    "; leave points out to take those of the file, or give the file resample = [nx, ny]";

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
    /// Repeats the one row of a profile, of which a process may hold none, over the rows that it holds of a map.
    ///
    /// # Errors
    /// A rank has ended.
    pub(super) fn repeat(&mut self, from: &Share, over: &Share) -> Result<(), BackendError> {
        let wanted = |rank: usize| {
            let is_any = !over.surface_rows_of(rank).is_empty();
            is_any.then_some(0).into_iter().collect()
        };
        let held = |rank: usize| from.surface_rows_of(rank);
        let row = from.fetch(&self.heights, self.points[0], held, wanted)?;
        self.heights = row.repeat(over.surface_rows().len());
        Ok(())
    }

    /// Refuses a map whose number of points differs from `points` (x, y), with a hint what to do.
    pub(super) fn compare_points(
        &self,
        points: [usize; 2],
        against: &'static str,
        hint: &'static str,
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
                hint
            },
        })
    }

    /// Refuses a map whose size differs from `size` (x, y), m, along x or, unless it is a profile, along y.
    pub(super) fn compare_size(
        &self,
        size: [f64; 2],
        against: &'static str,
        is_profile: bool,
    ) -> Result<(), FileError> {
        // A profile repeats across, however far.
        let axes = if is_profile { 1 } else { 2 };
        let differs = |found: [f64; 2], i: usize| {
            let off = (found[i] - size[i]).abs();
            off > SIZE_MARGIN * size[i]
        };
        match self.size {
            Some(found) if (0..axes).any(|i| differs(found, i)) => Err(FileError::OtherSize {
                found,
                against,
                size,
            }),
            _ => Ok(()),
        }
    }
}

/// Width of a pixel over its length, or the inverse, above which a map that does not say its size is taken for stretched.
const STRETCHED: f64 = 1.02;

impl HeightMap {
    /// A warning that a grid of equal sides makes the pixels of a map oblong which does not say its size.
    ///
    /// The pixels are those of so many columns and rows, from which it may have been resampled.
    pub(super) fn stretch(&self, grid: &Grid, [columns, rows]: [usize; 2]) -> Option<String> {
        let [dx, dy] = [grid.lx / columns as f64, grid.ly / rows as f64];
        let is_oblong = columns > 1 && rows > 1 && dx.max(dy) > STRETCHED * dx.min(dy);
        // Two sides are given because they differ.
        (self.size.is_none() && grid.lx == grid.ly && is_oblong).then(|| {
            format!(
                "the file does not say its size, and that of the grid makes the pixels of its {columns} x {rows} points {} x {}; if they are square, the size is {} x {}",
                format_si(dx, "m"),
                format_si(dy, "m"),
                format_si(grid.lx, "m"),
                format_si(grid.lx * rows as f64 / columns as f64, "m"),
            )
        })
    }
}

/// Reads the whole height map of a scene, and applies all that the scene asks of it.
///
/// # Errors
/// See [`FileError`]; a line scan is one unless the scene takes it as a profile, or its grid has the same `points`.
pub(super) fn read(
    scene: &HeightFileScene,
    boundary: Boundary,
    points: Option<[usize; 2]>,
) -> Result<HeightMap, FileError> {
    let map = formats::open_map(&scene.path, Opening::Whole)?;
    let matrix = if scene.preparation.profile {
        profile::to_profile(map)?
    } else {
        let matrix = map.read()?;
        expect_map(points, [matrix.columns, matrix.rows])?;
        matrix
    };
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

/// The same of factors, where a single row is a map too.
pub(super) fn read_factors(
    scene: &HeightFileScene,
    boundary: Boundary,
) -> Result<HeightMap, FileError> {
    let matrix = formats::open_map(&scene.path, Opening::Whole)?.read()?;
    expect_factors(matrix.unit)?;
    whole_heights_of(scene, boundary, matrix)
}

/// Refuses numbers in another unit of length than m, which many formats state of whatever they hold.
pub(super) fn expect_factors(unit: Option<f64>) -> Result<(), FileError> {
    match unit {
        Some(unit) if unit != 1.0 => Err(FileError::LengthsAsFactors { unit }),
        _ => Ok(()),
    }
}

fn whole_heights_of(
    scene: &HeightFileScene,
    boundary: Boundary,
    mut matrix: Matrix,
) -> Result<HeightMap, FileError> {
    if let Some(crop) = scene.preparation.crop {
        prepare::crop(&mut matrix, crop)?;
    }
    heights_of(scene, boundary, matrix, &|[nx, ny]| {
        Share::whole(Shape::whole(nx, ny))
    })
}

/// Heights of the rows that a process holds, of a matrix with these rows of its values; `share_of` says what it holds of so many
/// points. One that has ended is the caller's to see.
pub(super) fn heights_of(
    scene: &HeightFileScene,
    boundary: Boundary,
    matrix: Matrix,
    share_of: &dyn Fn([usize; 2]) -> Share,
) -> Result<HeightMap, FileError> {
    let asked = &scene.preparation;
    let mut points = [matrix.columns, matrix.rows];
    let share = &share_of(points);
    let unit = matrix.unit.unwrap_or(scene.unit);
    let [factor, zero] = factor_and_zero(&matrix, scene, unit)?;
    let mut heights = matrix.values;
    let mut warnings = matrix.warnings;
    let keeps_edges = asked.crop.is_none_or(|[x, y, ..]| [x, y] == [0, 0]);
    warnings.extend(matrix.frame.filter(|_| keeps_edges && !asked.profile));
    if let Some(unit) = matrix.lateral_unit {
        warnings.push(format!(
            "the file gives {unit:e} m as the unit of x, which only points x y z and a profile (profile = true) have"
        ));
    }
    let is_periodic = boundary == Boundary::Periodic;
    // Beyond the edges of a patch, which are made to meet or lie apart by its tilt, nothing is known.
    let may_wrap = is_periodic
        && asked.edges == Edges::None
        && !matches!(scene.detrend, Detrend::Plane | Detrend::Quadratic);
    check_missing(&heights, share, scene.fill, &mut warnings)?;
    if let Some(times) = asked.outliers {
        let found = outliers::drop_outliers(&mut heights, share, times);
        let all = points[0] * points[1];
        if found.count > 0 {
            warnings.push(format!(
                "{} of {all} points stand out of their neighbours by more than {times} standard deviations and are interpolated",
                found.count
            ));
        }
        if found.alone > 0 {
            warnings.push(format!(
                "{} of {all} points have no neighbour that is known, so that nothing tells whether they stand out; they are kept",
                found.alone
            ));
        }
        if found.are_few_different {
            warnings.push(format!(
                "most of the {all} points equal the median of their neighbours (terraces, or few levels), so that outliers = {times} is in \
                 standard deviations of the others: more than {:.3e} m stands out",
                times * found.deviation * factor.abs()
            ));
        }
    }
    // At once: a point that stands out is no neighbour to fill another from.
    fill_holes(&mut heights, share, may_wrap)?;

    if matrix.grey && scene.unit != 1.0 {
        warnings.push(format!(
            "unit = {:e} m does nothing for a grey image, whose heights run from black = {:e} m to white = {:e} m",
            scene.unit,
            zero,
            zero + factor
        ));
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
    if !closes
        && matches!(
            scene.detrend,
            Detrend::None | Detrend::Mean | Detrend::Lines
        )
    {
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
            let before = points;
            points = prepare::mirrored(before);
            let to = room_for(points, share_of)?;
            heights = or_missing(prepare::mirror(&heights, share, &to), &to);
            let longer = |side: f64, i: usize| side * (points[i] / before[i]) as f64;
            size = size.map(|[x, y]| [longer(x, 0), longer(y, 1)]);
            closes = true;
        }
    }
    if let Some([nx, ny]) = asked.resample {
        let from = share_of(points);
        points = [nx, if asked.profile { 1 } else { ny }];
        let to = room_for(points, share_of)?;
        // Edges that were made to meet are those of a periodic map, whatever lies beyond them.
        let is_closed = closes && (is_periodic || asked.edges != Edges::None);
        let found = if is_closed {
            resample::by_waves(heights, &from, &to)
        } else {
            resample::by_cubics(&heights, &from, &to)
        };
        heights = or_missing(found, &to);
    }
    if is_periodic && asked.edges == Edges::None {
        warnings.extend(match asked.resample {
            None => open_edges,
            Some(_) => edges(&heights, &share_of(points)),
        });
    }
    Ok(HeightMap {
        heights,
        points,
        size,
        warnings,
    })
}

/// What a process holds of so many points, if there may be so many and memory holds their heights.
fn room_for(
    points: [usize; 2],
    share_of: &dyn Fn([usize; 2]) -> Share,
) -> Result<Share, FileError> {
    let all = points[0].saturating_mul(points[1]);
    if all > MOST_POINTS {
        return Err(FileError::TooManyPoints { points: all as u64 });
    }
    let share = share_of(points);
    let reserved = Vec::<f64>::new().try_reserve_exact(share.surface_len());
    if share.any(reserved.is_err()) {
        let bytes = (all * size_of::<f64>()) as u64;
        return Err(FileError::Memory { bytes });
    }
    Ok(share)
}

/// Heights that were found, or missing ones where a process has ended.
fn or_missing(found: Result<Vec<f64>, BackendError>, share: &Share) -> Vec<f64> {
    found.unwrap_or_else(|_| vec![f64::NAN; share.surface_len()])
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

/// Fills what is missing: from across the edges too where those of the map meet.
fn fill_holes(heights: &mut [f64], share: &Share, may_wrap: bool) -> Result<(), FileError> {
    let missing: Vec<usize> = (0..heights.len())
        .filter(|place| !heights[*place].is_finite())
        .collect();
    fill::interpolate(heights, share, false)?;
    if may_wrap && share.any(!missing.is_empty()) && edges(heights, share).is_empty() {
        missing.iter().for_each(|place| heights[*place] = f64::NAN);
        fill::interpolate(heights, share, true)?;
    }
    Ok(())
}

/// Refuses missing pixels unless they are to be filled.
fn check_missing(
    values: &[f64],
    share: &Share,
    fill: Fill,
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
