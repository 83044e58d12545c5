//! The same surface on any grid.
//!
//! The phase of a self-affine wave depends on its index, so waves keep their phases as the grid is
//! refined, and a coarser grid only lacks the shortest ones. Shapes are formulas; their centre
//! stays where the scene's own grid has it. A periodic height file is interpolated by its Fourier
//! series. Surfaces that belong to one grid are refused.

use std::mem;

use num_complex::Complex;

use super::error::AccuracyError;
use crate::grid::{Grid, signed_index};
use crate::scene::{AdhesionMap, Boundary, GridScene, Scene, SurfacePart};
use crate::surface::shapes::ApexPosition;
use crate::surface::{Surface, SurfaceError, Top, fourier};

/// A scene whose surface is the same on every grid.
#[derive(Clone, Debug)]
pub struct GridIndependentSurface {
    /// The scene with the points and size of its own grid and fixed centres of its shapes.
    pub scene: Scene,
    /// Its own grid.
    pub grid: Grid,
    /// The summed Fourier series of its height files, by columns; `None` without files.
    files: Option<Vec<Complex<f64>>>,
    /// The heights of those files on their own grid.
    sampled: Vec<f64>,
    /// Warnings about its files.
    pub warnings: Vec<String>,
}

impl GridIndependentSurface {
    /// Finds the scene's own grid and fixes everything that would change with it.
    ///
    /// # Errors
    /// A height file that cannot be read; a height file on a free boundary or an adhesion map from
    /// a file, which belong to one grid.
    pub fn new(scene: &Scene) -> Result<GridIndependentSurface, AccuracyError> {
        let is_file =
            |part: &SurfacePart| matches!(part, SurfacePart::File(_) | SurfacePart::Heights(_));
        let has_file = scene.surfaces.iter().any(is_file);
        if has_file && scene.grid.boundary == Boundary::Free {
            return Err(AccuracyError::OneGrid {
                what: "a height file on a free boundary",
                remedy: "give the surface as shapes, or take boundary = \"periodic\" where the map allows it",
            });
        }
        let map = scene.adhesion.as_ref().and_then(|law| law.map.as_ref());
        if let Some(AdhesionMap::File(_) | AdhesionMap::Factors(_)) = map {
            return Err(AccuracyError::OneGrid {
                what: "adhesion.map from a file",
                remedy: "give it as a pattern, or leave it out",
            });
        }
        let mut files = None;
        let mut sampled = Vec::new();
        let mut warnings = Vec::new();
        let grid = if has_file {
            let parts: Vec<SurfacePart> = scene
                .surfaces
                .iter()
                .filter(|p| is_file(p))
                .cloned()
                .collect();
            let read = Surface::from_parts(&scene.grid, &parts)?;
            files = Some(fourier::analyse(&read.grid, &read.heights));
            sampled = read.heights.into_vec();
            warnings = read.warnings;
            read.grid
        } else {
            // Flat and already checked: only the scene's own numbers are used.
            Surface::from_parts(&scene.grid, &[SurfacePart::Flat])?.grid
        };
        let mut scene = scene.clone();
        scene.grid = GridScene {
            points: Some([grid.nx, grid.ny]),
            size: Some([grid.lx, grid.ly]),
            ..scene.grid
        };
        let boundary = scene.grid.boundary;
        scene.surfaces.retain(|part| !is_file(part));
        for part in &mut scene.surfaces {
            if let SurfacePart::Sphere { centre, .. } | SurfacePart::Cone { centre, .. } = part {
                let place = ApexPosition {
                    centre: *centre,
                    boundary,
                    first_row: 0,
                };
                *centre = Some(place.centre_on(&grid));
            }
        }
        if scene.surfaces.is_empty() {
            scene.surfaces.push(SurfacePart::Flat);
        }
        Ok(GridIndependentSurface {
            scene,
            grid,
            files,
            sampled,
            warnings,
        })
    }

    /// The surface on the grid of a scene made from [`GridIndependentSurface::scene`].
    ///
    /// # Errors
    /// Errors of the surface's parts on this grid, such as waves below two pixels.
    pub fn on(&self, scene: &Scene) -> Result<Surface, SurfaceError> {
        let mut surface = Surface::build(scene)?;
        let Some(series) = &self.files else {
            return Ok(surface);
        };
        let more = if [surface.grid.nx, surface.grid.ny] == [self.grid.nx, self.grid.ny] {
            self.sampled.clone()
        } else {
            fourier::synthesise(&surface.grid, resized(&self.grid, series, &surface.grid))
        };
        let mut heights = mem::replace(&mut surface.heights, Vec::new().into()).into_vec();
        for (height, more) in heights.iter_mut().zip(more) {
            *height += more;
        }
        surface.heights = heights.into();
        surface.highest = surface
            .heights
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max);
        surface.top = Top::Unknown;
        Ok(surface)
    }
}

/// The columns of a Fourier series on another grid of the same size: waves that it cannot resolve
/// are dropped, and the wave at the end of the old band is shared between both signs.
fn resized(from: &Grid, series: &[Complex<f64>], to: &Grid) -> Vec<Complex<f64>> {
    let columns = from.nx.min(to.nx) / 2 + 1;
    let mut found = vec![Complex::default(); columns * to.ny];
    for kx in 0..columns {
        if 2 * kx >= to.nx && kx > 0 {
            continue;
        }
        // The last column of an even grid is its own mirror image and is counted once there.
        let share_x = if 2 * kx == from.nx { 0.5 } else { 1.0 };
        for ky in 0..from.ny {
            let l = signed_index(ky, from.ny);
            let value = share_x * series[kx * from.ny + ky];
            let is_end = 2 * l.unsigned_abs() as usize == from.ny;
            let ends: &[i64] = if is_end { &[l, -l] } else { &[l] };
            for &l in ends {
                if 2 * l.unsigned_abs() as usize >= to.ny && l != 0 {
                    continue;
                }
                let row = l.rem_euclid(to.ny as i64) as usize;
                found[kx * to.ny + row] += value * if is_end { 0.5 } else { 1.0 };
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finer_grid_goes_through_the_points_of_the_coarser_one() {
        for [nx, ny] in [[8, 6], [7, 9], [4, 1]] {
            let coarse = Grid::new([nx, ny], [2.0, 1.0]);
            // Arbitrary heights, with the highest wave.
            let heights: Vec<f64> = (0..nx * ny)
                .map(|i| ((i * i * 31 + 7 * i) % 17) as f64)
                .collect();
            let series = fourier::analyse(&coarse, &heights);
            let fine = Grid::new([3 * nx, 3 * ny], [2.0, 1.0]);
            let refined = fourier::synthesise(&fine, resized(&coarse, &series, &fine));
            for y in 0..ny {
                for x in 0..nx {
                    let (old, new) = (heights[y * nx + x], refined[3 * y * 3 * nx + 3 * x]);
                    assert!((old - new).abs() < 1e-12, "{nx} x {ny}: {old} {new}");
                }
            }
            // And back: within the band the fine grid agrees with the coarse one, except at the
            // end.
            let again = resized(&fine, &fourier::analyse(&fine, &refined), &coarse);
            for kx in 0..nx.div_ceil(2) {
                for ky in (0..ny).filter(|ky| 2 * ky != ny) {
                    let (a, b) = (again[kx * ny + ky], series[kx * ny + ky]);
                    assert!((a - b).norm() < 1e-12, "{nx} x {ny}: mode {kx}, {ky}");
                }
            }
        }
    }
}
