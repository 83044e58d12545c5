//! Summary of a scene's surface without building its heights.
//!
//! `tabor check` of a large scene answers from its spectra and shapes; only height files are read.

use std::borrow::Cow;
use std::f64::consts::PI;

use super::error::{PartError, SurfaceError};
use super::shapes::{self, ApexPosition};
use super::spectrum::SpectralMoments;
use super::statistics::whole;
use super::summit::depths_of_highest;
use super::{Surface, Top, adhesion_map, check_grid, part_error, self_affine};
use crate::backend::Share;
use crate::grid::Grid;
use crate::scene::{AdhesionMap, Boundary, PatternKind, Scene, SurfacePart};

/// Points a side of the sample that gives the slope and curvature of a shape.
const SAMPLE: usize = 128;

/// Points within this share of all heights of an end are level with it.
const LEVEL: f64 = 1e-6;
/// Share of points that form a flat at the top, and on the ground.
const TOP: f64 = 0.01;
const GROUND: f64 = 0.1;

/// How the moments of an outline were found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// From the heights.
    Heights,
    /// From the sum over the modes of a spectrum, which equals that over the heights.
    Spectrum,
    /// Estimated: the parts' mean squares are added as if uncorrelated, a shape is sampled on fewer
    /// points, short waves are integrated, or edges of a free patch are left out.
    Estimate,
}

/// Grid, moments and warnings of a surface.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Outline {
    /// The grid, from the scene or from a height file.
    pub grid: Grid,
    /// Mean squares of height, slope and curvature.
    pub moments: SpectralMoments,
    /// How they were found.
    pub source: Source,
    /// Where it touches first, as far as its parts say.
    pub top: Top,
    /// Whether the surface consists of flats, as of pillars and punches, so that no curvature is meant.
    pub has_flats: bool,
    /// How far some of the highest points lie below the highest, m, ascending from 0; empty where there are no heights yet.
    pub highest: Vec<f64>,
    /// Summary of the adhesion map; `None` without one.
    pub map: Option<MapOutline>,
    /// Warnings for the user, one sentence each, naming the part.
    pub warnings: Vec<String>,
}

/// Summary of an adhesion map, the factors on the law's tension.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MapOutline {
    /// The largest factor.
    pub largest: f64,
    /// The mean over the grid.
    pub mean: f64,
    /// The standard deviation over the grid.
    pub deviation: f64,
}

impl MapOutline {
    /// Summary of a non-empty map, of which this process holds some rows.
    pub fn from_factors(map: &[f64], share: &Share) -> MapOutline {
        let count = (share.surface()[0] * share.surface()[1]) as f64;
        let mean = share.surface_sum_by(map, |f| f) / count;
        let square = share.surface_sum_by(map, |f| (f - mean) * (f - mean)) / count;
        MapOutline {
            largest: share.greatest_of(map).max(0.0),
            mean,
            deviation: square.sqrt(),
        }
    }

    /// Summary of two alternating factors on the points of a grid.
    ///
    /// # Errors
    /// A period that the grid does not hold.
    fn from_pattern(
        kind: PatternKind,
        period: f64,
        [low, high]: [f64; 2],
        grid: &Grid,
    ) -> Result<MapOutline, SurfaceError> {
        adhesion_map::check_period(kind, period, grid)?;
        let share = adhesion_map::low_share(kind, period, grid);
        Ok(MapOutline {
            largest: low.max(high),
            mean: share * low + (1.0 - share) * high,
            deviation: (share * (1.0 - share)).sqrt() * (high - low).abs(),
        })
    }
}

/// Whether many points are level with the highest, as of flat pillars and punches, or with the lowest, as between
/// pillars. Flats are wider than the crest of a ridge or a wave, whose one or two level points beside each other are many on
/// a coarse grid: they hold a point whose neighbours are level as well.
pub(crate) fn has_flats(heights: &[f64], share: &Share) -> bool {
    let (lowest, highest) = (share.least_of(heights), share.greatest_of(heights));
    let level = LEVEL * (highest - lowest);
    let nx = share.surface()[0].max(1);
    // Points that are level with an end, and those of them that have level neighbours.
    let near = |end: f64| {
        let is_near = |i: usize| (heights[i] - end).abs() <= level;
        let is_within = |i: usize, place: usize, count: usize, apart: usize| {
            count < 3
                || (place > 0 && place + 1 < count && is_near(i - apart) && is_near(i + apart))
        };
        let near = (0..heights.len()).filter(|&i| is_near(i));
        near.fold([0, 0], |[near, within], i| {
            let inner = is_within(i, i % nx, nx, 1) && is_within(i, i / nx, heights.len() / nx, nx);
            [near + 1, within + usize::from(inner)]
        })
    };
    let [[top, inner_top], [ground, inner_ground]] = [near(highest), near(lowest)];
    let [all, top, inner_top, ground, inner_ground] =
        share.counts([heights.len(), top, inner_top, ground, inner_ground]);
    let part = |count: usize| count as f64 / all as f64;
    let is_top = inner_top > 0 && part(top) > TOP;
    let is_ground = inner_ground > 0 && part(ground) > GROUND;
    highest > lowest && (is_top || is_ground)
}

/// Contribution of one part.
struct PartOutline {
    /// Mean squares of height, slope and Laplacian.
    mean_squares: [f64; 3],
    source: Source,
    warnings: Vec<String>,
}

impl Outline {
    /// Summarises a scene's surface. Needs no memory of the size of the grid, except for height
    /// files, whose heights are built and measured.
    ///
    /// # Errors
    /// As [`Surface::build`], except for overflow of the sum of the parts.
    pub fn from_scene(scene: &Scene) -> Result<Outline, SurfaceError> {
        let parts = &*joined(&scene.surfaces);
        if parts
            .iter()
            .any(|part| matches!(part, SurfacePart::File(_) | SurfacePart::Heights(_)))
        {
            return Ok(Outline::from_heights(
                &Surface::build(scene)?,
                scene.grid.boundary,
            ));
        }
        if parts.is_empty() {
            return Err(SurfaceError::Empty);
        }
        check_grid(scene.grid.points, scene.grid.size)?;
        let points = scene.grid.points.ok_or(SurfaceError::PointsMissing)?;
        let size = scene.grid.size.ok_or(SurfaceError::SizeMissing)?;
        let grid = Grid::new(points, size);
        let mut sums = [0.0; 3];
        let mut warnings = shared_seeds(parts);
        let mut source = Source::Spectrum;
        // Mean squares by seed: heights of one seed rise and fall together, and add by their roots.
        let mut rough: Vec<(u64, [f64; 3])> = Vec::new();
        for (index, part) in parts.iter().enumerate() {
            let found = part_outline(part, &grid, scene.grid.boundary)
                .map_err(|problem| part_error(index, problem))?;
            let seed = seed(part);
            match rough.iter_mut().find(|(other, _)| Some(*other) == seed) {
                Some((_, sums)) => {
                    for (sum, one) in sums.iter_mut().zip(found.mean_squares) {
                        *sum = (sum.sqrt() + one.sqrt()).powi(2);
                    }
                }
                None => match seed {
                    Some(seed) => rough.push((seed, found.mean_squares)),
                    None => add_squares(&mut sums, found.mean_squares),
                },
            }
            let named = |warning| format!("[[surface]] {}: {warning}", index + 1);
            warnings.extend(found.warnings.into_iter().map(named));
            if found.source == Source::Estimate {
                source = Source::Estimate;
            }
        }
        for (_, squares) in rough {
            add_squares(&mut sums, squares);
        }
        let single = single_part(parts);
        let has_shape = parts.iter().any(|part| !matches!(part, SurfacePart::Flat));
        if single.is_none() && has_shape {
            source = Source::Estimate;
        }
        Ok(Outline {
            grid,
            moments: SpectralMoments::from_isotropic(sums),
            source,
            top: Top::from_parts(parts),
            has_flats: false,
            highest: Vec::new(),
            map: match scene
                .adhesion
                .as_ref()
                .and_then(|adhesion| adhesion.map.as_ref())
            {
                Some(AdhesionMap::Pattern {
                    kind,
                    period,
                    low,
                    high,
                }) => {
                    let factors = [*low, *high];
                    Some(MapOutline::from_pattern(*kind, *period, factors, &grid)?)
                }
                _ => adhesion_map::build(scene, &grid, &whole)?
                    .as_deref()
                    .map(|map| MapOutline::from_factors(map, &whole(&grid))),
            },
            warnings,
        })
    }

    /// The outline of existing heights.
    pub fn from_heights(surface: &Surface, boundary: Boundary) -> Outline {
        Outline {
            grid: surface.grid,
            moments: surface.statistics(boundary).moments,
            source: Source::Heights,
            top: surface.top,
            has_flats: has_flats(&surface.heights, &whole(&surface.grid)),
            highest: depths_of_highest(&surface.heights, &whole(&surface.grid)),
            map: surface
                .adhesion_map
                .as_deref()
                .map(|map| MapOutline::from_factors(map, &whole(&surface.grid))),
            warnings: surface.warnings.clone(),
        }
    }
}

/// The one part that is not flat, if there is exactly one.
fn single_part(parts: &[SurfacePart]) -> Option<&SurfacePart> {
    let mut shaped = parts
        .iter()
        .filter(|part| !matches!(part, SurfacePart::Flat));
    let first = shaped.next();
    if shaped.next().is_some() { None } else { first }
}

/// The parts, with spheres about one centre as the one sphere that they are.
fn joined(parts: &[SurfacePart]) -> Cow<'_, [SurfacePart]> {
    let mut shaped = parts
        .iter()
        .filter(|part| !matches!(part, SurfacePart::Flat));
    match (Top::from_parts(parts), shaped.next(), shaped.next()) {
        (Top::Sphere(radius), Some(SurfacePart::Sphere { centre, .. }), Some(_)) => {
            let centre = *centre;
            vec![SurfacePart::Sphere { radius, centre }].into()
        }
        _ => parts.into(),
    }
}

fn add_squares(sums: &mut [f64; 3], squares: [f64; 3]) {
    for (sum, square) in sums.iter_mut().zip(squares) {
        *sum += square;
    }
}

/// Seed of a part with random phases.
fn seed(part: &SurfacePart) -> Option<u64> {
    match part {
        SurfacePart::SelfAffine(scene) => Some(scene.seed),
        _ => None,
    }
}

/// A warning of parts with random phases that have the seed of an earlier part.
pub(super) fn shared_seeds(parts: &[SurfacePart]) -> Vec<String> {
    let earlier = |index: usize| {
        let own = seed(&parts[index])?;
        parts[..index]
            .iter()
            .position(|part| seed(part) == Some(own))
    };
    let shared = (0..parts.len()).filter_map(|index| Some([earlier(index)?, index]));
    shared
        .map(|[first, second]| {
            format!(
                "[[surface]] {} has the seed of [[surface]] {}: their waves of one length are the same, and add up as those of one surface; give it another seed",
                second + 1,
                first + 1
            )
        })
        .collect()
}

fn part_outline(
    part: &SurfacePart,
    grid: &Grid,
    boundary: Boundary,
) -> Result<PartOutline, PartError> {
    let place = |centre: Option<[f64; 2]>| ApexPosition {
        centre,
        boundary,
        first_row: 0,
    };
    match part {
        SurfacePart::Flat | SurfacePart::File(_) | SurfacePart::Heights(_) => Ok(PartOutline {
            mean_squares: [0.0; 3],
            source: Source::Spectrum,
            warnings: Vec::new(),
        }),
        SurfacePart::Sphere { radius, centre } => {
            let place = place(*centre);
            sampled(grid, place, |heights, grid| {
                shapes::add_sphere(heights, grid, *radius, place)
            })
        }
        SurfacePart::Cone { half_angle, centre } => {
            let place = place(*centre);
            sampled(grid, place, |heights, grid| {
                shapes::add_cone(heights, grid, *half_angle, place)
            })
        }
        SurfacePart::Wavy {
            amplitude,
            wavelength,
        } => {
            shapes::check_waves(grid, *amplitude, *wavelength, boundary)?;
            Ok(waves(*amplitude, *wavelength, boundary))
        }
        SurfacePart::SelfAffine(scene) => {
            let mut warnings = Vec::new();
            let found = self_affine::survey(scene, grid, &mut warnings)?;
            let sums = found.held;
            Ok(PartOutline {
                mean_squares: [sums.height, sums.slope, sums.curvature],
                source: match (found.exact, boundary) {
                    (true, Boundary::Periodic) => Source::Spectrum,
                    _ => Source::Estimate,
                },
                warnings,
            })
        }
    }
}

/// Mean squares of a sphere or a cone from a sample of it on fewer points.
fn sampled(
    grid: &Grid,
    place: ApexPosition,
    add: impl Fn(&mut [f64], &Grid) -> Result<(), PartError>,
) -> Result<PartOutline, PartError> {
    let fewer = Grid::new(
        [grid.nx.min(SAMPLE), grid.ny.min(SAMPLE)],
        [grid.lx, grid.ly],
    );
    let mut heights = vec![0.0; fewer.len()];
    add(&mut heights, &fewer)?;
    // Differences, not waves: the edge jump of a shape that is not periodic does not count.
    let moments =
        super::statistics::Statistics::from_heights(&fewer, &heights, Boundary::Free).moments;
    Ok(PartOutline {
        mean_squares: [
            moments.m0,
            moments.rms_slope().powi(2),
            moments.rms_curvature().powi(2),
        ],
        source: Source::Estimate,
        warnings: place.warning(grid).into_iter().collect(),
    })
}

/// Mean squares of waves over whole periods.
fn waves(amplitude: f64, wavelength: [f64; 2], boundary: Boundary) -> PartOutline {
    let wavenumbers = wavelength.map(|length| 2.0 * PI / length);
    let share = |wavenumber: f64| if wavenumber > 0.0 { 0.5 } else { 1.0 };
    let height = amplitude * amplitude * share(wavenumbers[0]) * share(wavenumbers[1]);
    let square = wavenumbers[0].powi(2) + wavenumbers[1].powi(2);
    PartOutline {
        mean_squares: [height, height * square, height * square * square],
        source: match boundary {
            Boundary::Periodic => Source::Spectrum,
            Boundary::Free => Source::Estimate,
        },
        warnings: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pillars_have_flats_and_rough_surfaces_have_none() {
        let of = |points: usize| whole(&Grid::new([points, 1], [1.0, 1.0]));
        let pillars: Vec<f64> = (0..400).map(|i| f64::from(u8::from(i % 20 < 4))).collect();
        assert!(has_flats(&pillars, &of(pillars.len())));
        let round: Vec<f64> = (0..400)
            .map(|i| (1.0 - 0.1 * f64::from(i % 20 - 3).powi(2)).max(0.0))
            .collect();
        assert!(has_flats(&round, &of(round.len())));
        let rough: Vec<f64> = (0..400).map(|i| f64::from((i * 37) % 211)).collect();
        assert!(!has_flats(&rough, &of(rough.len())));
        assert!(!has_flats(&[1.0; 9], &of(9)));
    }

    /// On few points the crest of a smooth surface holds many of them.
    #[test]
    fn crests_are_no_flats() {
        let [nx, ny] = [16, 8];
        let share = whole(&Grid::new([nx, ny], [2.0, 1.0]));
        let of = |height: &dyn Fn(f64, f64) -> f64| -> bool {
            let points = (0..nx * ny).map(|i| height((i % nx) as f64, (i / nx) as f64));
            has_flats(&points.collect::<Vec<f64>>(), &share)
        };
        let wave = |place: f64| (PI * place / 4.0).cos();
        assert!(!of(&|x, _| wave(x)));
        // A crest between two points.
        assert!(!of(&|x, _| wave(x + 0.5)));
        assert!(!of(&|_, y| wave(y)));
        assert!(!of(&|x, y| wave(x) + wave(y)));
        assert!(!of(&|x, y| wave(x + 0.5) + wave(y + 0.5)));
        // A pillar of three by three points, and a wall.
        assert!(of(&|x, y| f64::from(u8::from(
            (x - 4.0).abs() < 2.0 && (y - 4.0).abs() < 2.0
        ))));
        assert!(of(&|x, _| f64::from(u8::from((x - 4.0).abs() < 2.0))));
    }
}
