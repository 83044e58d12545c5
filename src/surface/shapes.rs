//! Simple shapes: sphere, cone, waves.
//!
//! Every function adds its heights to those present, shape `[ny, nx]`, m.

use std::f64::consts::PI;

use rayon::prelude::*;

use super::error::PartError;
use crate::grid::Grid;
use crate::scene::Boundary;

/// Relative deviation from a whole number of waves across a periodic grid that is accepted.
///
/// A wavelength is written with few digits; within this margin the periodic one is taken.
const WAVES_MARGIN: f64 = 1e-6;

/// Where a shape stands: its apex and the boundary.
#[derive(Clone, Copy, Debug)]
pub struct ApexPosition {
    /// Apex (x, y), m; `None` is the middle of the points.
    pub centre: Option<[f64; 2]>,
    /// A periodic grid repeats the shape: each point uses the nearest image.
    pub boundary: Boundary,
    /// The row of the grid at which the heights begin.
    pub first_row: usize,
}

impl ApexPosition {
    /// The apex (x, y) on this grid, m.
    pub fn centre_on(&self, grid: &Grid) -> [f64; 2] {
        self.centre.unwrap_or([
            (grid.nx as f64 - 1.0) * grid.dx() / 2.0,
            (grid.ny as f64 - 1.0) * grid.dy() / 2.0,
        ])
    }

    /// Warns of an apex beyond a free grid, where nothing touches, or at its edge, which cuts the part.
    pub fn warning(&self, grid: &Grid) -> Option<String> {
        if self.boundary != Boundary::Free {
            return None;
        }
        let [x, y] = self.centre_on(grid);
        let axes = [(x, grid.dx(), grid.nx), (y, grid.dy(), grid.ny)];
        // Whether the apex lies beyond so many pixels within the first and last points.
        let beyond = |pixels: f64, (at, pixel, points): (f64, f64, usize)| {
            let last = (points as f64 - 1.0) * pixel;
            !(pixels * pixel..=last - pixels * pixel).contains(&at)
        };
        // The grid ends with the pixels around its first and last points.
        if axes.into_iter().any(|axis| beyond(-0.5, axis)) {
            return Some(format!(
                "the centre ({x:e}, {y:e}) m lies outside of the free grid, where the surfaces would touch first"
            ));
        }
        let cut = axes.into_iter().any(|axis| axis.2 > 2 && beyond(0.5, axis));
        cut.then(|| {
            format!(
                "the centre ({x:e}, {y:e}) m lies at the edge of the free grid, which cuts the part in two: x and y begin at a corner; leave centre out for the middle"
            )
        })
    }
}

/// Adds the paraboloid `-r^2 / (2 radius)` with its apex at height 0.
///
/// # Errors
/// A radius that is not positive; a centre that is not finite.
pub fn add_sphere(
    heights: &mut [f64],
    grid: &Grid,
    radius: f64,
    place: ApexPosition,
) -> Result<(), PartError> {
    positive("radius", radius)?;
    add_round(heights, grid, place, |square| -square / (2.0 * radius))
}

/// Adds the cone `-r / tan(half_angle)` with its apex at height 0; `half_angle` in rad.
///
/// # Errors
/// An angle that is not between 0 and 90 degrees; a centre that is not finite.
pub fn add_cone(
    heights: &mut [f64],
    grid: &Grid,
    half_angle: f64,
    place: ApexPosition,
) -> Result<(), PartError> {
    let degrees = half_angle.to_degrees();
    if !(degrees > 0.0 && degrees < 90.0) {
        return Err(PartError::HalfAngle { degrees });
    }
    let flank = 1.0 / half_angle.tan();
    add_round(heights, grid, place, |square| -square.sqrt() * flank)
}

/// Adds `amplitude cos(2 pi x / wavelength_x) cos(2 pi y / wavelength_y)`; an infinite wavelength
/// gives a factor of 1. The heights begin at a row of the grid.
///
/// # Errors
/// Values that are not lengths; waves shorter than two pixels; waves that are not periodic on a
/// periodic grid.
pub fn add_waves(
    heights: &mut [f64],
    grid: &Grid,
    amplitude: f64,
    wavelength: [f64; 2],
    boundary: Boundary,
    first_row: usize,
) -> Result<(), PartError> {
    finite("amplitude", amplitude)?;
    let along_x = wave("x", grid.nx, grid.lx, wavelength[0], boundary)?;
    let along_y = wave("y", grid.ny, grid.ly, wavelength[1], boundary)?;
    for (row, factor) in heights.chunks_mut(grid.nx).zip(&along_y[first_row..]) {
        for (height, wave) in row.iter_mut().zip(&along_x) {
            *height += amplitude * factor * wave;
        }
    }
    Ok(())
}

/// The checks of [`add_waves`] alone.
///
/// # Errors
/// As [`add_waves`].
pub fn check_waves(
    grid: &Grid,
    amplitude: f64,
    wavelength: [f64; 2],
    boundary: Boundary,
) -> Result<(), PartError> {
    finite("amplitude", amplitude)?;
    wave("x", grid.nx, grid.lx, wavelength[0], boundary)?;
    wave("y", grid.ny, grid.ly, wavelength[1], boundary)?;
    Ok(())
}

/// Adds `profile(r^2)` around the apex.
fn add_round(
    heights: &mut [f64],
    grid: &Grid,
    place: ApexPosition,
    profile: impl Fn(f64) -> f64 + Sync,
) -> Result<(), PartError> {
    let centre = place.centre_on(grid);
    finite("centre x", centre[0])?;
    finite("centre y", centre[1])?;
    let distances = |points: usize, pixel: f64, size: f64, centre: f64| -> Vec<f64> {
        (0..points)
            .map(|i| {
                let distance = i as f64 * pixel - centre;
                match place.boundary {
                    Boundary::Free => distance,
                    Boundary::Periodic => distance - size * (distance / size).round(),
                }
            })
            .collect()
    };
    let along_x = distances(grid.nx, grid.dx(), grid.lx, centre[0]);
    let along_y = distances(grid.ny, grid.dy(), grid.ly, centre[1]);
    heights
        .par_chunks_mut(grid.nx)
        .zip(&along_y[place.first_row..])
        .for_each(|(row, y)| {
            for (height, x) in row.iter_mut().zip(&along_x) {
                *height += profile(x * x + y * y);
            }
        });
    Ok(())
}

/// A cosine at the points of one axis, crest at the first.
fn wave(
    axis: &'static str,
    points: usize,
    size: f64,
    wavelength: f64,
    boundary: Boundary,
) -> Result<Vec<f64>, PartError> {
    if wavelength == f64::INFINITY {
        return Ok(vec![1.0; points]);
    }
    positive("wavelength", wavelength)?;
    let pixel = size / points as f64;
    if wavelength < 2.0 * pixel * (1.0 - WAVES_MARGIN) {
        return Err(PartError::WavesTooShort {
            axis,
            wavelength,
            pixel,
        });
    }
    let mut waves = size / wavelength;
    if boundary == Boundary::Periodic {
        let whole = waves.round().max(1.0);
        if (waves - whole).abs() > WAVES_MARGIN * whole {
            return Err(PartError::WavesDoNotClose {
                axis,
                wavelength,
                size,
                waves,
                nearest: size / whole,
            });
        }
        waves = whole;
    }
    Ok((0..points)
        .map(|i| {
            // Take the fraction of a period first: the argument stays small and periods repeat
            // exactly.
            let periods = waves * i as f64 / points as f64;
            (2.0 * PI * periods.fract()).cos()
        })
        .collect())
}

/// Refuses a number that is not positive and finite.
fn positive(name: &'static str, value: f64) -> Result<(), PartError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(PartError::NotPositive { name, value })
    }
}

/// Refuses a non-finite number.
fn finite(name: &'static str, value: f64) -> Result<(), PartError> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(PartError::NotFinite { name, value })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIODIC: ApexPosition = ApexPosition {
        centre: None,
        boundary: Boundary::Periodic,
        first_row: 0,
    };

    fn at(centre: [f64; 2], boundary: Boundary) -> ApexPosition {
        ApexPosition {
            centre: Some(centre),
            boundary,
            first_row: 0,
        }
    }

    #[test]
    fn a_free_grid_warns_of_an_apex_outside_and_at_its_edge() {
        let grid = Grid::new([8, 4], [8.0, 4.0]);
        for (centre, words) in [
            ([3.5, 1.5], None),
            ([0.5, 2.5], None),
            ([0.0, 0.0], Some("at the edge")),
            ([7.0, 1.5], Some("at the edge")),
            ([3.5, 3.4], Some("at the edge")),
            ([-0.5, 3.5], Some("at the edge")),
            ([-0.6, 1.5], Some("outside")),
            ([9.0, 1.0], Some("the centre (9e0, 1e0) m lies outside")),
            ([3.5, 4.0], Some("outside")),
        ] {
            let said = at(centre, Boundary::Free).warning(&grid);
            let is_said = said
                .as_ref()
                .map(|said| words.is_some_and(|words| said.contains(words)));
            assert_eq!(is_said, words.map(|_| true), "{centre:?}: {said:?}");
            assert_eq!(at(centre, Boundary::Periodic).warning(&grid), None);
        }
        // Of few points none is inside.
        let place = ApexPosition {
            centre: None,
            boundary: Boundary::Free,
            first_row: 0,
        };
        for points in [[1, 1], [2, 2], [3, 3]] {
            assert_eq!(place.warning(&Grid::new(points, [1.0, 1.0])), None);
        }
    }

    #[test]
    fn the_default_centre_is_a_pixel_corner_for_even_numbers() {
        let grid = Grid::new([4, 5], [4.0, 10.0]);
        assert_eq!(PERIODIC.centre_on(&grid), [1.5, 4.0]);
        let mut heights = vec![0.0; 20];
        add_sphere(&mut heights, &grid, 2.0, PERIODIC).unwrap();
        assert_eq!(heights[2 * 4 + 1], -0.25 / 4.0);
        assert_eq!(heights[2 * 4 + 2], -0.25 / 4.0);
        // Rows are y: one pixel of 2 up from the middle, half a pixel of 1 to the side.
        assert_eq!(heights[3 * 4 + 2], -(4.0 + 0.25) / 4.0);
    }

    #[test]
    fn shapes_wrap_round_only_on_a_periodic_grid() {
        let grid = Grid::new([8, 4], [8.0, 4.0]);
        let mut periodic = vec![0.0; 32];
        add_sphere(
            &mut periodic,
            &grid,
            1.0,
            at([0.0, 0.0], Boundary::Periodic),
        )
        .unwrap();
        assert_eq!(periodic[7], -0.5);
        assert_eq!(periodic[3 * 8], -0.5);
        assert_eq!(periodic[4], -8.0);
        // An image of the same apex far away gives the same shape.
        let mut image = vec![0.0; 32];
        add_sphere(
            &mut image,
            &grid,
            1.0,
            at([-16.0, 40.0], Boundary::Periodic),
        )
        .unwrap();
        assert_eq!(periodic, image);
        let mut free = vec![0.0; 32];
        add_sphere(&mut free, &grid, 1.0, at([0.0, 0.0], Boundary::Free)).unwrap();
        assert_eq!(free[7], -24.5);
    }

    #[test]
    fn a_cone_falls_with_its_flank() {
        let grid = Grid::new([8, 8], [8.0, 8.0]);
        let mut heights = vec![0.0; 64];
        let angle = 60.0_f64.to_radians();
        add_cone(&mut heights, &grid, angle, at([0.0, 0.0], Boundary::Free)).unwrap();
        assert_eq!(heights[0], 0.0);
        // r = 5 at (3, 4); tan 60 degrees = sqrt 3.
        approx::assert_relative_eq!(
            heights[4 * 8 + 3],
            -5.0 / 3.0_f64.sqrt(),
            max_relative = 1e-14
        );
    }

    #[test]
    fn waves_have_their_crest_at_the_first_point() {
        let grid = Grid::new([8, 4], [1.0, 2.0]);
        let mut egg_box = vec![0.0; 32];
        add_waves(&mut egg_box, &grid, 3.0, [0.5, 2.0], Boundary::Periodic, 0).unwrap();
        assert_eq!(egg_box[0], 3.0);
        assert_eq!(egg_box[2], -3.0);
        assert_eq!(egg_box[2 * 8], -3.0);
        assert_eq!(egg_box[2 * 8 + 2], 3.0);
        let mut ridges = vec![0.0; 32];
        add_waves(
            &mut ridges,
            &grid,
            3.0,
            [1.0, f64::INFINITY],
            Boundary::Periodic,
            0,
        )
        .unwrap();
        assert_eq!(ridges[..8], ridges[24..]);
        assert_eq!(ridges[4], -3.0);
    }

    #[test]
    fn waves_must_close_and_be_resolved() {
        let grid = Grid::new([8, 8], [1.0, 1.0]);
        let add = |wavelength: [f64; 2], boundary| {
            add_waves(&mut [0.0; 64], &grid, 1.0, wavelength, boundary, 0)
                .map_err(|e| e.to_string())
        };
        let message = add([0.3, 1.0], Boundary::Periodic).unwrap_err();
        assert!(message.contains("along x does not divide"), "{message}");
        let message = add([1.0, 3.0], Boundary::Periodic).unwrap_err();
        assert!(message.contains("along y does not divide"), "{message}");
        let message = add([0.1, 1.0], Boundary::Periodic).unwrap_err();
        assert!(message.contains("shorter than two pixels"), "{message}");
        assert_eq!(add([0.3, 3.0], Boundary::Free), Ok(()));
        assert_eq!(add([0.333_333_3, 0.5], Boundary::Periodic), Ok(()));
        assert!(add([f64::NAN, 1.0], Boundary::Free).is_err());
        assert!(add([-1.0, 1.0], Boundary::Free).is_err());
    }

    #[test]
    fn invalid_shapes_are_refused() {
        let grid = Grid::new([2, 2], [1.0, 1.0]);
        let mut heights = [0.0; 4];
        assert!(add_sphere(&mut heights, &grid, 0.0, PERIODIC).is_err());
        assert!(add_sphere(&mut heights, &grid, f64::INFINITY, PERIODIC).is_err());
        assert!(add_cone(&mut heights, &grid, 0.0, PERIODIC).is_err());
        assert!(add_cone(&mut heights, &grid, PI / 2.0 + 0.01, PERIODIC).is_err());
        let nowhere = at([f64::NAN, 0.0], Boundary::Free);
        assert!(add_sphere(&mut heights, &grid, 1.0, nowhere).is_err());
    }
}
