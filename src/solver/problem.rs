//! A contact problem in reduced units, ready to be solved.

use std::f64::consts::PI;
use std::sync::Arc;

use super::heights::Heights;
use super::stiffness;
use crate::backend::long_field::LongField;
use crate::backend::ranks::Ranks;
use crate::backend::{
    Backend, BackendError, Factors, Level, Response, Shape, Share, Spectrum, host_fields,
};
use crate::elastic::{HalfSpace, Layer, Stiffness, StiffnessTable};
use crate::grid::{Boundary, Grid};
use crate::law::Law;
use crate::shared_values::SharedValues;

/// What one reduced unit is worth in SI units.
///
/// Vertical lengths are in units of the roughness, lateral ones in pixels, pressures in what a
/// vertical unit of displacement over a pixel takes, so that all numbers are near 1 and the
/// eigenvalues of the stiffness lie below pi.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// Vertical length, m.
    pub length: f64,
    /// Lateral length, m.
    pub lateral: f64,
    /// Pressure, Pa.
    pub pressure: f64,
}

/// Heights, elasticity and law of a contact, in reduced units.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The grid, SI.
    pub grid: Grid,
    /// What lies beyond its edge.
    pub boundary: Boundary,
    /// Points that are solved for; more than the grid's on a free boundary.
    pub shape: Shape,
    /// Those of them that this process holds: all, or a rank's slab. Fields here and in a solver are of these.
    pub share: Share,
    /// Units.
    pub scales: Scales,
    /// Heights of the held grid points less `height_origin`, reduced.
    pub heights: Heights,
    /// Their mean (periodic) or highest value (free), m: subtracted in double precision, so that the
    /// solution does not depend on the origin of the heights.
    pub height_origin: f64,
    /// Root mean square slope.
    pub rms_slope: f64,
    /// The law, reduced.
    pub law: Law,
    /// Factors on the law's tension, one a held grid point; `None` where the law is the same everywhere.
    pub law_factor: Option<Vec<f64>>,
    /// Largest net pressure, at which the solid yields, reduced; `None` for an elastic one.
    pub hardness: Option<f64>,
    /// The layer in place of the half-space (periodic grids), SI.
    pub layer: Option<Layer>,
    /// Stiffness at each wavevector; its zero mode is 0 (periodic) or the free half-space's.
    pub stiffness: Stiffness,
    /// Whether the conductance of its contacts is computed.
    pub conducts: bool,
}

/// Smallest even size of at least `points` whose prime factors are 2, 3, 5 and 7.
pub fn good_size(points: usize) -> usize {
    let is_good = |size: &usize| {
        let mut rest = *size;
        for prime in [2, 3, 5, 7] {
            while rest.is_multiple_of(prime) {
                rest /= prime;
            }
        }
        rest == 1
    };
    let least = points.max(2).next_multiple_of(2);
    // A power of two is one, so the search ends there at the latest.
    let most = least.next_power_of_two();
    (least..most).step_by(2).find(is_good).unwrap_or(most)
}

/// The points that are solved for: on a free boundary with a pad that keeps the images apart.
pub fn solved_shape(grid: &Grid, boundary: Boundary) -> Shape {
    match boundary {
        Boundary::Periodic => Shape::whole(grid.nx, grid.ny),
        Boundary::Free => Shape {
            points: [good_size(2 * grid.nx - 1), good_size(2 * grid.ny - 1)],
            surface: [grid.nx, grid.ny],
        },
    }
}

/// Displacement at the centre of a rectangle of these sides under a unit pressure on a contact modulus of 1 (Love 1929): the
/// mean of a free boundary's solved points, whose table repeats.
fn uniform_displacement([a, b]: [f64; 2]) -> f64 {
    2.0 / PI * (a * (b / a).asinh() + b * (a / b).asinh())
}

impl Problem {
    /// A problem from heights in metres (`[ny, nx]`, row-major), a contact modulus in Pa and a law
    /// in SI units.
    pub fn new(
        grid: Grid,
        boundary: Boundary,
        contact_modulus: f64,
        heights: &[f64],
        rms_slope: f64,
        law: Law,
    ) -> Self {
        let heights = heights.to_vec().into();
        let share = Problem::share(&grid, boundary, None);
        Problem::sharing(
            share,
            grid,
            boundary,
            contact_modulus,
            heights,
            rms_slope,
            law,
        )
    }

    /// The part of a problem on this grid that each of these processes holds.
    pub fn share(grid: &Grid, boundary: Boundary, ranks: Option<Arc<dyn Ranks>>) -> Share {
        Share::on_ranks(solved_shape(grid, boundary), ranks)
    }

    /// The same of heights that somebody else holds too, those of the held rows.
    pub fn sharing(
        share: Share,
        grid: Grid,
        boundary: Boundary,
        contact_modulus: f64,
        heights: SharedValues,
        rms_slope: f64,
        law: Law,
    ) -> Self {
        let count = grid.len() as f64;
        let mean = share.surface_sum_by(&heights, |h| h) / count;
        let square = share.surface_sum_by(&heights, |h| (h - mean) * (h - mean));
        let rms = (square / count).sqrt();
        let highest = share.greatest_of(&heights);
        let lateral = (grid.dx() * grid.dy()).sqrt();
        let length = if rms > 0.0 {
            rms
        } else if law.is_adhesive() {
            law.range()
        } else {
            lateral
        };
        let scales = Scales {
            length,
            lateral,
            pressure: contact_modulus * length / lateral,
        };
        let height_origin = match boundary {
            Boundary::Periodic => mean,
            Boundary::Free => highest,
        };
        let shape = solved_shape(&grid, boundary);
        let stiffness = match boundary {
            Boundary::Periodic => stiffness::periodic(grid, lateral, None, &share),
            Boundary::Free => {
                let pixel = [grid.dx() / lateral, grid.dy() / lateral];
                stiffness::free(&share, pixel)
            }
        };
        Problem {
            grid,
            boundary,
            shape,
            scales,
            heights: Heights::new(heights, height_origin, length, &share, &grid),
            share,
            height_origin,
            rms_slope,
            law: law.reduced(length, scales.pressure),
            stiffness,
            law_factor: None,
            hardness: None,
            layer: None,
            conducts: false,
        }
    }

    /// The same problem on a perfectly plastic solid of a hardness (Pa).
    pub fn with_hardness(self, hardness: f64) -> Problem {
        Problem {
            hardness: Some(hardness / self.scales.pressure),
            ..self
        }
    }

    /// The same problem on a layer in place of the half-space (periodic grids).
    pub fn on_layer(self, layer: Layer) -> Problem {
        let lateral = self.scales.lateral;
        let stiffness = if self.is_sketch() {
            stiffness::along_axes(self.grid, lateral, &layer)
        } else {
            stiffness::periodic(self.grid, lateral, Some(&layer), &self.share)
        };
        Problem {
            stiffness,
            layer: Some(layer),
            ..self
        }
    }

    /// The same problem with the conductance of its contacts.
    pub fn with_conductance(self) -> Problem {
        Problem {
            conducts: true,
            ..self
        }
    }

    /// The same problem with the law's tension multiplied by a factor at each grid point.
    pub fn with_adhesion_map(self, factor: Vec<f64>) -> Problem {
        Problem {
            law_factor: Some(factor),
            ..self
        }
    }

    /// The same problem on a solid of another contact modulus (Pa), with a law in SI units.
    pub fn with_contact_modulus(&self, contact_modulus: f64, law: Law) -> Problem {
        let scales = Scales {
            pressure: contact_modulus * self.scales.length / self.scales.lateral,
            ..self.scales
        };
        Problem {
            scales,
            law: law.reduced(scales.length, scales.pressure),
            hardness: self
                .hardness
                .map(|hardness| hardness * (self.scales.pressure / scales.pressure)),
            ..self.clone()
        }
    }

    /// A problem with a shape and a law (SI) but no values: no heights, and of a table of stiffness the zero wavevector and the
    /// softest wave, nearly; of a layer the waves along the axes. A solver planned on it counts the cost of the problem and cannot solve it.
    pub fn sketch(grid: Grid, boundary: Boundary, contact_modulus: f64, law: Law) -> Self {
        let scales = Scales {
            length: 1.0,
            lateral: 1.0,
            pressure: contact_modulus,
        };
        let shape = solved_shape(&grid, boundary);
        Problem {
            grid,
            boundary,
            shape,
            share: Problem::share(&grid, boundary, None),
            scales,
            heights: Heights::none(),
            height_origin: 0.0,
            rms_slope: 0.0,
            law: law.reduced(scales.length, scales.pressure),
            stiffness: match boundary {
                Boundary::Periodic => Stiffness::HalfSpace(HalfSpace::new(grid, scales.lateral)),
                Boundary::Free => {
                    let size = [grid.dx(), grid.dy()];
                    let sides: [f64; 2] = std::array::from_fn(|axis| {
                        shape.points[axis] as f64 * size[axis] / scales.lateral
                    });
                    let solved = Grid::new(shape.points, sides);
                    let softest = HalfSpace::new(solved, scales.lateral).least();
                    let zero_mode = 1.0 / uniform_displacement(sides);
                    Stiffness::Table(StiffnessTable::sketch(zero_mode, softest))
                }
            },
            law_factor: None,
            hardness: None,
            layer: None,
            conducts: false,
        }
    }

    /// Whether it was made by [`Problem::sketch`].
    pub fn is_sketch(&self) -> bool {
        self.heights.are_none()
    }

    /// The same problem without attraction.
    pub fn without_adhesion(&self) -> Problem {
        Problem {
            law: Law::HardWall,
            law_factor: None,
            ..self.clone()
        }
    }

    /// The same problem on half the points each way, or `None` where they cannot be halved.
    ///
    /// # Errors
    /// Another rank has ended.
    pub fn coarsened(&self) -> Result<Option<Problem>, BackendError> {
        let [nx, ny] = self.shape.points;
        if self.boundary == Boundary::Free || nx % 2 != 0 || ny % 2 != 0 {
            return Ok(None);
        }
        let grid = Grid::new([nx / 2, ny / 2], [self.grid.lx, self.grid.ly]);
        let share = self.share.of(Shape::whole(grid.nx, grid.ny));
        // The rows of the coarse grid are shared anew, so that some of those above may lie elsewhere.
        let above = if share.is_whole() {
            None
        } else {
            let own: Vec<f64> = self.heights.iter().collect();
            let held = |rank| self.share.rows_of(rank);
            let wanted = |rank| {
                let rows = share.rows_of(rank);
                (2 * rows.start..2 * rows.end).collect()
            };
            Some(self.share.fetch(&own, nx, held, wanted)?)
        };
        let own_height = self.heights.by_point();
        let height_at = |point: usize| match &above {
            None => own_height(point),
            Some(heights) => heights[point],
        };
        let mut heights = vec![0.0; share.len()];
        host_fields::change_rows(&mut heights, grid.nx, |row, line| {
            for (column, height) in line.iter_mut().enumerate() {
                let at = 2 * row * nx + 2 * column;
                *height = 0.25
                    * (height_at(at)
                        + height_at(at + 1)
                        + height_at(at + nx)
                        + height_at(at + nx + 1));
            }
        });
        Ok(Some(Problem {
            grid,
            shape: Shape::whole(grid.nx, grid.ny),
            heights: Heights::new(heights.into(), 0.0, 1.0, &share, &grid),
            stiffness: stiffness::periodic(grid, self.scales.lateral, self.layer.as_ref(), &share),
            share,
            law: self.law,
            // Coarse starts are for the hard wall only.
            law_factor: None,
            // The full grid finds where the solid yields.
            hardness: None,
            conducts: false,
            ..*self
        }))
    }

    /// Highest reduced height, as sampled.
    pub fn highest(&self) -> f64 {
        self.heights.highest()
    }

    /// Root mean square of the reduced heights about their mean.
    pub fn rms_height(&self) -> f64 {
        self.heights.rms()
    }

    /// Largest stiffness over all wavevectors.
    pub fn stiffness_max(&self) -> f64 {
        self.stiffness.largest()
    }

    /// Least stiffness over the wavevectors other than zero.
    pub fn stiffness_min(&self) -> f64 {
        self.stiffness.least()
    }

    /// Makes the spectrum of the stiffness, or of its inverse, on a level of the solved points; 0 where
    /// the stiffness is 0.
    pub fn spectrum(
        &self,
        backend: &mut dyn Backend,
        level: Level,
        name: &'static str,
        response: Response,
    ) -> Spectrum {
        let factor = |[kx, ky]: [usize; 2]| response.factor(self.stiffness.at(kx, ky));
        let factors = match self.stiffness {
            Stiffness::HalfSpace(half_space) => Factors::HalfSpace(half_space, response),
            Stiffness::Layer(_) | Stiffness::Table(_) => Factors::Each(&factor),
        };
        backend.spectrum(level, name, factors)
    }

    /// Displacement of a uniform unit pressure on a layer, reduced; 0 on the half-space, whose
    /// periodic cell leaves it open.
    pub fn uniform_compliance(&self) -> f64 {
        self.layer.map_or(0.0, |layer| {
            layer.uniform_compliance() / self.scales.lateral
        })
    }

    /// Spreads values on the grid over the solved points, `outside` on a pad; those of the held rows.
    pub fn padded(&self, values: &[f64], outside: f64) -> Vec<f64> {
        let width = self.shape.points[0];
        let nx = self.shape.surface[0];
        if self.shape.points == self.shape.surface || self.is_sketch() {
            return values.to_vec();
        }
        let mut padded = vec![outside; self.share.len()];
        let lines = padded.chunks_exact_mut(width);
        for (line, values) in lines.zip(values.chunks_exact(nx)) {
            line[..nx].copy_from_slice(values);
        }
        padded
    }

    /// The height at each point of a held row of solved points, 0 on a pad.
    pub fn padded_row(&self, row: usize) -> impl Fn(usize) -> f64 + '_ {
        let row = self.heights.row(row, self.shape.surface[0]);
        move |x| row(x).unwrap_or(0.0)
    }

    /// The heights over all held solved points, 0 on a pad; none of a sketch.
    pub fn padded_heights(&self) -> LongField<f64> {
        let rows = if self.is_sketch() {
            0
        } else {
            self.share.rows().len()
        };
        let width = self.shape.points[0];
        let mut heights = LongField::zeros(rows * width);
        host_fields::change_rows(&mut heights, width, |row, line| {
            let height_at = self.padded_row(row);
            for (x, height) in line.iter_mut().enumerate() {
                *height = height_at(x);
            }
        });
        heights
    }

    /// The grid's values out of those over all solved points, each of the held rows.
    pub fn on_surface<'a>(&self, values: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let width = self.shape.points[0];
        let (nx, ny) = (self.shape.surface[0], self.share.surface_rows().len());
        let lines = values.chunks_exact(width).take(ny);
        lines.flat_map(move |line| line[..nx].iter().copied())
    }

    /// Places of the grid's points among all solved points, each of the held rows.
    pub fn surface_places(&self) -> impl Iterator<Item = usize> + use<> {
        let (width, nx) = (self.shape.points[0], self.shape.surface[0]);
        let rows = self.share.surface_rows().len();
        (0..rows).flat_map(move |row| row * width..row * width + nx)
    }

    /// The grid's values out of those over all solved points, as a field of its own.
    pub fn surface_part(&self, values: &[f64]) -> Vec<f64> {
        // Its length is known here, so that it does not grow into the memory of two.
        let mut part = Vec::with_capacity(self.share.surface_len());
        part.extend(self.on_surface(values));
        part
    }

    /// The same in the place of the values.
    pub fn cut_to_surface(&self, values: LongField<f64>) -> LongField<f64> {
        if self.shape.points == self.shape.surface {
            values
        } else {
            self.surface_part(&values).into()
        }
    }
}

#[cfg(test)]
#[path = "problem_tests.rs"]
mod tests;
