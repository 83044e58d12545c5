//! What is known of a scene's surface before its heights are made.
//!
//! A check of a large scene answers from its spectra and shapes; only height files are read.

use std::f64::consts::PI;

use super::error::{PartError, SurfaceError};
use super::shapes::{self, Place};
use super::spectrum::SpectralMoments;
use super::{Surface, adhesion_map, check_grid, of_part, self_affine, single_part};
use crate::grid::Grid;
use crate::scene::{AdhesionMap, Boundary, Scene, SurfacePart};

/// Points a side of the sample from which the slope and curvature of a shape are taken.
const SAMPLE: usize = 128;

/// How the moments of an outline were found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// From the heights.
    Heights,
    /// From the sum over the modes of a spectrum, which is what the heights have.
    Spectrum,
    /// Estimated: the parts' own mean squares added up as if they knew nothing of each other, a shape
    /// sampled on fewer points, short waves as an integral, or edges of a free patch left out.
    Estimate,
}

/// Grid, moments and warnings of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// The grid, from the scene or from a height file.
    pub grid: Grid,
    /// Mean squares of height, slope and curvature.
    pub moments: SpectralMoments,
    /// How they were found.
    pub source: Source,
    /// Radius, m, of a surface that is exactly one sphere.
    pub sphere_radius: Option<f64>,
    /// The map of factors on the law's tension, where the scene names one.
    pub map: Option<MapOutline>,
    /// What the author should know, one sentence each, naming the part.
    pub warnings: Vec<String>,
}

/// What is known of a map of factors on the law's tension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapOutline {
    /// The largest factor.
    pub largest: f64,
    /// The mean over the grid.
    pub mean: f64,
    /// The standard deviation over the grid.
    pub deviation: f64,
}

impl MapOutline {
    /// That of a map that is there; it is not empty.
    pub fn of(map: &[f64]) -> MapOutline {
        let count = map.len() as f64;
        let mean = map.iter().sum::<f64>() / count;
        let square = map.iter().map(|f| (f - mean) * (f - mean)).sum::<f64>() / count;
        MapOutline {
            largest: map.iter().copied().fold(0.0, f64::max),
            mean,
            deviation: square.sqrt(),
        }
    }

    /// That of two factors in turn, but for the pixels where they meet.
    pub fn of_pattern(low: f64, high: f64) -> MapOutline {
        MapOutline {
            largest: low.max(high),
            mean: 0.5 * (low + high),
            deviation: 0.5 * (high - low).abs(),
        }
    }
}

/// What one part gives to the whole.
struct PartOutline {
    /// Mean squares of height, slope and Laplacian.
    mean_squares: [f64; 3],
    source: Source,
    warnings: Vec<String>,
}

impl Outline {
    /// Looks at a scene's surface. Takes no memory of the size of the grid, unless a part is a height
    /// file: then the heights are built and measured.
    ///
    /// # Errors
    /// As [`Surface::build`], but for sums of parts past the range of numbers.
    pub fn of(scene: &Scene) -> Result<Outline, SurfaceError> {
        let parts = &scene.surfaces;
        if parts
            .iter()
            .any(|part| matches!(part, SurfacePart::File(_) | SurfacePart::Heights(_)))
        {
            return Ok(Outline::measured(
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
        let mut warnings = Vec::new();
        let mut source = Source::Spectrum;
        for (index, part) in parts.iter().enumerate() {
            let found = part_outline(part, &grid, scene.grid.boundary)
                .map_err(|problem| of_part(index, problem))?;
            for (sum, one) in sums.iter_mut().zip(found.mean_squares) {
                *sum += one;
            }
            let named = |warning| format!("[[surface]] {}: {warning}", index + 1);
            warnings.extend(found.warnings.into_iter().map(named));
            if found.source == Source::Estimate {
                source = Source::Estimate;
            }
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
            sphere_radius: match single {
                Some(SurfacePart::Sphere { radius, .. }) => Some(*radius),
                _ => None,
            },
            map: match scene
                .adhesion
                .as_ref()
                .and_then(|adhesion| adhesion.map.as_ref())
            {
                Some(AdhesionMap::Pattern { low, high, .. }) => {
                    Some(MapOutline::of_pattern(*low, *high))
                }
                _ => adhesion_map::build(scene, &grid)?
                    .as_deref()
                    .map(MapOutline::of),
            },
            warnings,
        })
    }

    /// The outline of heights that are there.
    pub fn measured(surface: &Surface, boundary: Boundary) -> Outline {
        Outline {
            grid: surface.grid,
            moments: surface.statistics(boundary).moments,
            source: Source::Heights,
            sphere_radius: surface.sphere_radius,
            map: surface.adhesion_map.as_deref().map(MapOutline::of),
            warnings: surface.warnings.clone(),
        }
    }
}

fn part_outline(
    part: &SurfacePart,
    grid: &Grid,
    boundary: Boundary,
) -> Result<PartOutline, PartError> {
    let place = |centre: Option<[f64; 2]>| Place { centre, boundary };
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
    place: Place,
    add: impl Fn(&mut [f64], &Grid) -> Result<(), PartError>,
) -> Result<PartOutline, PartError> {
    let fewer = Grid::new(
        [grid.nx.min(SAMPLE), grid.ny.min(SAMPLE)],
        [grid.lx, grid.ly],
    );
    let mut heights = vec![0.0; fewer.len()];
    add(&mut heights, &fewer)?;
    // Differences, not waves: the edges of a shape that does not repeat are no part of it.
    let moments = super::statistics::Statistics::of(&fewer, &heights, Boundary::Free).moments;
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
