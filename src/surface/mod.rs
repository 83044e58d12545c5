//! Heights: the sum of a scene's surface parts on its grid.
//!
//! ```
//! use tabor::grid::Grid;
//! use tabor::surface::{self_affine, spectrum::SelfAffineSpectrum};
//!
//! let spectrum = SelfAffineSpectrum { hurst: 0.8, long: 1.0, rolloff: 4.0, short: 16.0, plateau: 1.0 };
//! let grid = Grid::new([64, 64], [6.283185307179586; 2]);
//! let heights = self_affine::heights(&spectrum.with_rms_height(1.0), &grid, 1);
//! assert_eq!(heights.len(), 64 * 64);
//! ```

mod error;
mod fourier;
pub mod self_affine;
pub mod shapes;
pub mod spectrum;
pub mod statistics;

pub use error::{FileError, PartError, SurfaceError};

use crate::grid::Grid;
use crate::scene::{Boundary, Scene, SurfacePart};
use shapes::Place;

/// Most points of a grid: 8 GiB of heights.
pub const MOST_POINTS: usize = 1 << 30;

/// Heights on a grid, and what is known about them.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// The grid, from the scene or from a height file.
    pub grid: Grid,
    /// Heights, m, shape `[ny, nx]`, row-major, positive towards the solid.
    pub heights: Vec<f64>,
    /// The highest point, m, from which the approach counts: of a surface that is exactly one sphere
    /// or one cone its true apex, else the highest sampled point.
    pub highest: f64,
    /// Radius, m, of a surface that is exactly one sphere.
    pub sphere_radius: Option<f64>,
    /// What the author should know, one sentence each, naming the part.
    pub warnings: Vec<String>,
}

impl Surface {
    /// Builds the heights of a scene: finds its grid and adds up its parts.
    ///
    /// # Errors
    /// See [`SurfaceError`]; an error of a part names it by its number, from 1.
    pub fn build(scene: &Scene) -> Result<Surface, SurfaceError> {
        if scene.surfaces.is_empty() {
            return Err(SurfaceError::Empty);
        }
        let grid = resolve_grid(scene)?;
        let mut heights = zeros(&grid)?;
        let mut warnings = Vec::new();
        for (index, part) in scene.surfaces.iter().enumerate() {
            let mut found = Vec::new();
            add_part(&mut heights, part, &grid, scene.grid.boundary, &mut found).map_err(
                |problem| SurfaceError::Part {
                    part: index + 1,
                    problem: Box::new(problem),
                },
            )?;
            warnings.extend(
                found
                    .into_iter()
                    .map(|warning| format!("[[surface]] {}: {warning}", index + 1)),
            );
        }
        if let Some(index) = heights.iter().position(|height| !height.is_finite()) {
            return Err(SurfaceError::NotFinite {
                row: index / grid.nx,
                column: index % grid.nx,
            });
        }
        let sampled = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let single = single_part(&scene.surfaces);
        Ok(Surface {
            grid,
            heights,
            highest: match single {
                Some(SurfacePart::Sphere { .. } | SurfacePart::Cone { .. }) => 0.0,
                _ => sampled,
            },
            sphere_radius: match single {
                Some(SurfacePart::Sphere { radius, .. }) => Some(*radius),
                _ => None,
            },
            warnings,
        })
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

/// The grid of a scene, checked.
fn resolve_grid(scene: &Scene) -> Result<Grid, SurfaceError> {
    let points = scene.grid.points.ok_or(SurfaceError::PointsMissing)?;
    let size = scene.grid.size.ok_or(SurfaceError::SizeMissing)?;
    let count = points[0].checked_mul(points[1]);
    if !count.is_some_and(|count| (1..=MOST_POINTS).contains(&count)) {
        return Err(SurfaceError::Points { points });
    }
    if !size.iter().all(|side| side.is_finite() && *side > 0.0) {
        return Err(SurfaceError::Size { size });
    }
    Ok(Grid::new(points, size))
}

/// Heights of 0, if the memory of this machine holds them.
fn zeros(grid: &Grid) -> Result<Vec<f64>, SurfaceError> {
    let mut heights = Vec::new();
    heights
        .try_reserve_exact(grid.len())
        .map_err(|_| SurfaceError::Memory {
            points: [grid.nx, grid.ny],
        })?;
    heights.resize(grid.len(), 0.0);
    Ok(heights)
}

/// Adds one part to the heights.
fn add_part(
    heights: &mut [f64],
    part: &SurfacePart,
    grid: &Grid,
    boundary: Boundary,
    warnings: &mut Vec<String>,
) -> Result<(), PartError> {
    let place = |centre: Option<[f64; 2]>| Place { centre, boundary };
    match part {
        SurfacePart::Flat => Ok(()),
        SurfacePart::Sphere { radius, centre } => {
            shapes::add_sphere(heights, grid, *radius, place(*centre))
        }
        SurfacePart::Cone { half_angle, centre } => {
            shapes::add_cone(heights, grid, *half_angle, place(*centre))
        }
        SurfacePart::Wavy {
            amplitude,
            wavelength,
        } => shapes::add_waves(heights, grid, *amplitude, *wavelength, boundary),
        SurfacePart::SelfAffine(scene) => {
            let rough = self_affine::build(scene, grid, warnings)?;
            add(heights, &rough);
            Ok(())
        }
        SurfacePart::File(scene) => Err(PartError::File {
            path: scene.path.clone(),
            problem: FileError::NotInThisVersion {
                extension: String::new(),
            },
        }),
    }
}

/// Adds heights point by point.
fn add(heights: &mut [f64], more: &[f64]) {
    for (height, more) in heights.iter_mut().zip(more) {
        *height += more;
    }
}
