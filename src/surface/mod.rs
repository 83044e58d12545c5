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

mod across;
mod adhesion_map;
mod array;
mod band_estimate;
mod by_rows;
pub mod correlation;
mod detrend;
mod error;
mod file;
mod file_error;
mod fill;
pub mod fit;
mod formats;
pub(crate) mod fourier;
mod matrix;
mod outliers;
mod outline;
mod prepare;
mod profile;
mod resample;
#[doc(hidden)]
pub mod roughness;
#[doc(hidden)]
pub mod self_affine;
#[doc(hidden)]
pub mod shapes;
pub mod spectrum;
pub mod statistics;
mod summit;
mod top;

pub use adhesion_map::MapError;
pub(crate) use by_rows::points_before_resampling;
pub use error::{PartError, SurfaceError};
pub use file_error::FileError;
#[doc(hidden)]
pub use formats::claimed_points;
pub(crate) use formats::instrument_header;
pub(crate) use outline::has_flats;
#[doc(hidden)]
pub use outline::{MapOutline, Outline, Source};
pub(crate) use summit::depths_of_highest;

use std::borrow::Cow;
use std::sync::Arc;

use crate::backend::ranks::Ranks;
use crate::backend::{Share, host_fields};
use crate::grid::Grid;
use crate::scene::{Boundary, GridScene, Scene, SelfAffineScene, SurfacePart};
use crate::shared_values::SharedValues;
use crate::solver::Problem;
use crate::units::{LARGEST, in_range};
use by_rows::Reading;
use file::HeightMap;
use shapes::ApexPosition;
pub use statistics::Statistics;
use statistics::whole;
#[doc(hidden)]
pub use top::Top;

/// Most points of a grid, 131072 x 131072; where a length has 32 bits, 2^30.
#[doc(hidden)]
pub const MOST_POINTS: usize = match 1_usize.checked_shl(34) {
    Some(points) => points,
    None => 1 << 30,
};

/// Heights on a grid, with their reference height and adhesion map.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Surface {
    /// The grid, from the scene or from a height file.
    pub grid: Grid,
    /// Heights, m, shape `[ny, nx]`, row-major, positive towards the solid.
    /// Whoever needs them shares them.
    pub heights: SharedValues,
    /// Height from which the approach counts, m: the true apex if the surface is exactly a sphere
    /// or one cone, else the highest sampled point.
    #[doc(hidden)]
    pub highest: f64,
    /// Where it touches first, as far as its parts say.
    #[doc(hidden)]
    pub top: Top,
    /// Factors on the tension of the scene's law, shape `[ny, nx]`; `None` without a map.
    pub adhesion_map: Option<Vec<f64>>,
    /// Warnings for the user, one sentence each, naming the part.
    pub warnings: Vec<String>,
}

impl Surface {
    /// Builds the heights of a scene: finds its grid and adds up its parts.
    ///
    /// # Errors
    /// See [`SurfaceError`]; an error of a part names it by its number, from 1.
    pub fn build(scene: &Scene) -> Result<Surface, SurfaceError> {
        Surface::on_ranks(scene, None)
    }

    /// The same of the rows that one of these processes holds.
    ///
    /// # Errors
    /// As [`Surface::build`], on all of them.
    #[doc(hidden)]
    pub fn on_ranks(scene: &Scene, ranks: Option<Arc<dyn Ranks>>) -> Result<Surface, SurfaceError> {
        let share = |grid: &Grid| Problem::share(grid, scene.grid.boundary, ranks.clone());
        let surface = Surface::from_parts_on(&scene.grid, &scene.surfaces, &share)?;
        Ok(Surface {
            adhesion_map: adhesion_map::build(scene, &surface.grid, &share)?,
            ..surface
        })
    }

    /// Builds the heights of `parts` on the grid of `scene`, or on that of a height file among them.
    ///
    /// # Errors
    /// As [`Surface::build`].
    pub fn from_parts(scene: &GridScene, parts: &[SurfacePart]) -> Result<Surface, SurfaceError> {
        Surface::from_parts_on(scene, parts, &whole)
    }

    /// The same of the rows of a share.
    fn from_parts_on(
        scene: &GridScene,
        parts: &[SurfacePart],
        share: &dyn Fn(&Grid) -> Share,
    ) -> Result<Surface, SurfaceError> {
        if parts.is_empty() {
            return Err(SurfaceError::Empty);
        }
        // Check the scene's own numbers before a file is read or memory is allocated.
        check_grid(scene.points, scene.size)?;
        let mut maps = read_maps(scene, parts, share)?;
        let grid = resolve_grid(scene, &maps)?;
        let share = share(&grid);
        let mut warnings = outline::shared_seeds(parts);
        let heights = match parts {
            // An array alone is the sum of the parts as it stands.
            [SurfacePart::Heights(array)] if share.is_whole() => {
                array::heights(array, &grid).map_err(|problem| part_error(0, problem))?;
                array.shared()
            }
            _ => sum_of(
                parts,
                &mut maps,
                &grid,
                &share,
                scene.boundary,
                &mut warnings,
            )?
            .into(),
        };
        // Beyond this range squares of curvatures overflow.
        let fits = |height: &f64| height.abs() <= LARGEST;
        if let Some(error) = share.failure() {
            return Err(error.into());
        }
        let first = share.surface_rows().start * grid.nx;
        let unfit = heights.iter().position(|height| !fits(height));
        let unfit = share.least(unfit.map_or(f64::INFINITY, |index| (first + index) as f64));
        if unfit.is_finite() {
            let index = unfit as usize;
            return Err(SurfaceError::NotFinite {
                row: index / grid.nx + 1,
                column: index % grid.nx + 1,
            });
        }
        let sampled = share.greatest_of(&heights);
        let top = Top::from_parts(parts);
        Ok(Surface {
            grid,
            heights,
            highest: match top {
                Top::Sphere(_) | Top::Cone { .. } => 0.0,
                _ => sampled,
            },
            top,
            adhesion_map: None,
            warnings,
        })
    }

    /// Root mean squares, moments and extremes of the heights; see [`Statistics::from_heights`].
    pub fn statistics(&self, boundary: Boundary) -> Statistics {
        Statistics::from_heights(&self.grid, &self.heights, boundary)
    }
}

/// An error of the part at `index`.
fn part_error(index: usize, problem: PartError) -> SurfaceError {
    SurfaceError::Part {
        part: index + 1,
        problem: Box::new(problem),
    }
}

/// Refuses numbers of points and sizes outside the limits of a grid.
fn check_grid(points: Option<[usize; 2]>, size: Option<[f64; 2]>) -> Result<(), SurfaceError> {
    if let Some(points) = points {
        let count = points[0].checked_mul(points[1]);
        if !count.is_some_and(|count| (1..=MOST_POINTS).contains(&count)) {
            return Err(SurfaceError::Points { points });
        }
    }
    if let Some(size) = size
        && !size.iter().all(|side| *side > 0.0 && in_range(*side))
    {
        return Err(SurfaceError::Size { size });
    }
    Ok(())
}

/// The height maps of the parts that are files, of several processes their rows; `None` for the others.
///
/// Each is compared with the scene's grid as soon as it is read; the first mismatch is the error.
fn read_maps(
    scene: &GridScene,
    parts: &[SurfacePart],
    share: &dyn Fn(&Grid) -> Share,
) -> Result<Vec<Option<HeightMap>>, SurfaceError> {
    let mut maps = Vec::with_capacity(parts.len());
    let mut points = scene.points.map(|points| (points, "[grid] points"));
    let mut size = scene.size.map(|size| (size, "[grid] size"));
    for (index, part) in parts.iter().enumerate() {
        let SurfacePart::File(file) = part else {
            maps.push(None);
            continue;
        };
        let of_file = |problem| {
            let path = file.path.clone();
            part_error(index, PartError::File { path, problem })
        };
        let map = Reading {
            scene: file,
            boundary: scene.boundary,
            share: &|points| share(&Grid::new(points, [1.0; 2])),
            repeats: scene.points.filter(|_| file.preparation.profile),
            whole: &|| file::read(file, scene.boundary, scene.points),
            shades: None,
            fits: &|points| match file.preparation.profile {
                true => Ok(()),
                false => file::expect_map(scene.points, points),
            },
            wrong: &of_file,
        };
        let map = map.read()?;
        if let Some((points, against)) = points {
            map.compare_points(points, against, file::OTHER_POINTS)
                .map_err(of_file)?;
        }
        if let Some((size, against)) = size {
            let is_profile = file.preparation.profile;
            map.compare_size(size, against, is_profile)
                .map_err(of_file)?;
        }
        points = points.or(Some((map.points, "an earlier height file")));
        size = size.or(map.size.map(|size| (size, "an earlier height file")));
        maps.push(Some(map));
    }
    Ok(maps)
}

/// The grid of a scene, or of its height files, which agree with it.
fn resolve_grid(scene: &GridScene, maps: &[Option<HeightMap>]) -> Result<Grid, SurfaceError> {
    let mut maps_read = maps.iter().flatten();
    let points = scene
        .points
        .or(maps_read.clone().next().map(|map| map.points));
    let size = scene.size.or(maps_read.find_map(|map| map.size));
    let points = points.ok_or(SurfaceError::PointsMissing)?;
    let size = size.ok_or(SurfaceError::SizeMissing)?;
    check_grid(Some(points), Some(size))?;
    Ok(Grid::new(points, size))
}

/// The sum of the held heights of `parts`, of which files were read into `maps`.
fn sum_of(
    parts: &[SurfacePart],
    maps: &mut [Option<HeightMap>],
    grid: &Grid,
    share: &Share,
    boundary: Boundary,
    warnings: &mut Vec<String>,
) -> Result<Vec<f64>, SurfaceError> {
    let mut heights = reserved(grid, share)?;
    for (index, part) in parts.iter().enumerate() {
        let mut found = Vec::new();
        match maps[index].take() {
            Some(map) => {
                if let SurfacePart::File(file) = part
                    && !file.preparation.profile
                {
                    let points = points_before_resampling(file).unwrap_or(map.points);
                    found.extend(map.stretch(grid, points));
                }
                found.extend(map.warnings);
                add(&mut heights, map.heights.into());
            }
            None => add_part(&mut heights, part, grid, share, boundary, &mut found)
                .map_err(|problem| part_error(index, problem))?,
        }
        let named = |warning| format!("[[surface]] {}: {warning}", index + 1);
        warnings.extend(found.into_iter().map(named));
    }
    started(&mut heights, share);
    Ok(heights)
}

/// Memory for the heights of the held rows, if this machine has so much. It is empty until the first part.
fn reserved(grid: &Grid, share: &Share) -> Result<Vec<f64>, SurfaceError> {
    let mut heights = Vec::new();
    let reserved = heights.try_reserve_exact(share.surface_len());
    if share.any(reserved.is_err()) {
        return Err(SurfaceError::Memory {
            points: [grid.nx, grid.ny],
        });
    }
    Ok(heights)
}

/// Heights to which a shape can be added: zeros before the first part.
fn started<'a>(heights: &'a mut Vec<f64>, share: &Share) -> &'a mut [f64] {
    if heights.is_empty() {
        heights.resize(share.surface_len(), 0.0);
    }
    heights
}

/// Adds one part to the heights.
fn add_part(
    heights: &mut Vec<f64>,
    part: &SurfacePart,
    grid: &Grid,
    share: &Share,
    boundary: Boundary,
    warnings: &mut Vec<String>,
) -> Result<(), PartError> {
    let first_row = share.surface_rows().start;
    let place = |centre: Option<[f64; 2]>| ApexPosition {
        centre,
        boundary,
        first_row,
    };
    match part {
        SurfacePart::Flat => Ok(()),
        SurfacePart::Sphere { radius, centre } => {
            warnings.extend(place(*centre).warning(grid));
            shapes::add_sphere(started(heights, share), grid, *radius, place(*centre))
        }
        SurfacePart::Cone { half_angle, centre } => {
            warnings.extend(place(*centre).warning(grid));
            shapes::add_cone(started(heights, share), grid, *half_angle, place(*centre))
        }
        SurfacePart::Wavy {
            amplitude,
            wavelength,
        } => {
            let heights = started(heights, share);
            shapes::add_waves(heights, grid, *amplitude, *wavelength, boundary, first_row)
        }
        SurfacePart::SelfAffine(scene) => {
            let rough = self_affine::build(scene, grid, share, warnings)?;
            add(heights, rough.into());
            Ok(())
        }
        SurfacePart::Heights(array) => {
            let whole = array::heights(array, grid)?;
            let held = &whole[first_row * grid.nx..][..share.surface_len()];
            add(heights, held.into());
            Ok(())
        }
        // A file's heights were read and added before.
        SurfacePart::File(_) => Ok(()),
    }
}

impl SelfAffineScene {
    /// Heights of the surface on a grid, m, shape `[ny, nx]`, row-major: the same surface on every grid that
    /// holds its waves, with every number of threads.
    ///
    /// ```
    /// use tabor::{Grid, Roughness, SelfAffine};
    ///
    /// let rough = SelfAffine {
    ///     hurst: 0.8,
    ///     roughness: Roughness::RmsHeight(10e-9),
    ///     longest: 20e-6,
    ///     rolloff: 5e-6,
    ///     shortest: 1e-6,
    ///     seed: 1,
    /// };
    /// let heights = rough.heights(Grid::new([64, 32], [20e-6, 10e-6]))?;
    /// assert_eq!(heights.len(), 32 * 64);
    /// # Ok::<(), tabor::surface::SurfaceError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Surface::build`]: values out of range, and a band of which the grid holds nothing.
    pub fn heights(&self, grid: Grid) -> Result<Vec<f64>, SurfaceError> {
        SurfacePart::from(self.clone()).heights(grid, Boundary::Periodic)
    }
}

impl SurfacePart {
    /// Heights of the part on a grid, m, shape `[ny, nx]`, row-major, positive towards the solid.
    ///
    /// # Errors
    /// As [`Surface::build`].
    pub fn heights(&self, grid: Grid, boundary: Boundary) -> Result<Vec<f64>, SurfaceError> {
        let scene = GridScene::new([grid.nx, grid.ny], [grid.lx, grid.ly]).boundary(boundary);
        let surface = Surface::from_parts(&scene, std::slice::from_ref(self))?;
        Ok(surface.heights.into_vec())
    }
}

/// Adds heights point by point; the first ones are taken as they are.
fn add(heights: &mut Vec<f64>, more: Cow<[f64]>) {
    if heights.is_empty() {
        *heights = more.into_owned();
    } else {
        host_fields::change(heights, |point, height| *height += more[point]);
    }
}
