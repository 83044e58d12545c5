//! Evaluation of a solved state: fields in SI units, area fractions, energies.

use std::borrow::Cow;
use std::f64::consts::{LN_2, PI};

use super::control::{Controller, Position};
use super::row::State;
use super::setup::Setup;
use crate::grid::Boundary;
use crate::law::{Law, Support, net_pressure};
use crate::scene::FieldName;
use crate::solver::{Load, Problem};

/// Attraction below this share of the law's peak does not count as attraction.
const NEGLIGIBLE: f64 = 1e-9;

/// State of a point of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum PointState {
    /// Beyond the range of the law.
    Separated,
    /// Not in contact, with a gap below the range.
    Attracted,
    /// In contact.
    Contact,
}

/// A solved state on the grid, with its sums.
#[derive(Clone, Debug)]
pub struct Evaluation {
    /// Gap, m, shape `[ny, nx]`.
    pub gap: Vec<f64>,
    /// Net pressure, Pa, positive in compression, shape `[ny, nx]`.
    pub pressure: Vec<f64>,
    /// Constant that turns gap + heights into the displacement, m.
    pub displacement_offset: f64,
    /// State of each point.
    pub points: Vec<PointState>,
    /// Rigid positions.
    pub position: Position,
    /// Net force on the grid, N.
    pub force: f64,
    /// Share of points in contact.
    pub contact: f64,
    /// Share of points attracted.
    pub attracted: f64,
    /// Contact share less the pixel staircase, where a wall makes contact sharp.
    pub contact_corrected: Option<f64>,
    /// Elastic energy, J.
    pub elastic_energy: f64,
    /// Energy of adhesion, J.
    pub adhesive_energy: f64,
    /// Contact state.
    pub state: State,
    /// Depth by which plastic indentation has lowered the heights, this step included, m, shape
    /// `[ny, nx]`; empty for an elastic solid.
    pub plastic_depth: Vec<f64>,
}

/// Solved fields over all solved points, reduced, and the mean pressure that is held.
pub struct Solved<'a> {
    /// Gap; below zero it is the plastic indentation of this step. The result takes its place.
    pub gap: Vec<f64>,
    /// K*(g + h). The net pressure takes its place.
    pub elastic: Vec<f64>,
    /// Mean over all solved points of the offset by the history of a viscoelastic solid.
    pub mean_offset: f64,
    /// Depth by which plastic indentation had lowered the heights before, over all solved points; empty
    /// where there was none.
    pub plastic_depth: &'a [f64],
    /// Mean pressure.
    pub held: f64,
    /// The load it was solved for.
    pub load: Load,
    /// Factors on the law's tension where they are not the setup's own, one a grid point. The energy of
    /// adhesion uses the setup's own: the further work of a receding edge is dissipated, not stored.
    pub law_factor: Option<&'a [f64]>,
}

impl Evaluation {
    /// Evaluates a solved state of `problem`. The law is the setup's own, also where the problem was
    /// solved without it: then attraction is summed outside the contact of the hard wall.
    pub fn new(setup: &Setup, problem: &Problem, controller: &Controller, solved: Solved) -> Self {
        let scales = problem.scales;
        let law = setup.law.reduced(scales.length, scales.pressure);
        let closed_support = if setup.sums_attraction() {
            Support::WallAlone
        } else {
            Support::Wall
        };
        // The heights as earlier indentation has left them.
        let lowered = || {
            let depths = solved.plastic_depth;
            let heights = problem.padded_heights().enumerate();
            heights.map(move |(i, h)| h - depths.get(i).copied().unwrap_or(0.0))
        };
        let displacement = solved.gap.iter().zip(lowered()).map(|(g, h)| g + h);
        let mean_displacement =
            displacement.sum::<f64>() / problem.shape.len() as f64 + solved.mean_offset;
        let count = problem.grid.len() as f64;
        let yields = problem.hardness.is_some();
        let mut plastic_depth = match (yields, solved.plastic_depth) {
            (false, _) => Vec::new(),
            (true, []) => vec![0.0; problem.grid.len()],
            (true, before) => problem.surface_part(before),
        };
        // Plastic indentation moves the bodies together and leaves no gap.
        for (depth, g) in plastic_depth
            .iter_mut()
            .zip(problem.on_surface(&solved.gap))
        {
            *depth -= g.min(0.0);
        }
        let open = |g: f64| if yields { g.max(0.0) } else { g };
        let mean_gap = problem.on_surface(&solved.gap).map(open).sum::<f64>() / count;
        let mean_depth = plastic_depth.iter().fold(0.0, |sum, depth| sum + depth) / count;
        let position = controller.position(
            &solved.load,
            solved.held,
            mean_displacement,
            [mean_gap, mean_depth],
        );
        let offset = controller.offset(&position, mean_displacement);

        let energy_unit = scales.length * scales.pressure * problem.grid.pixel_area();
        // <u, Ku>/2 over all solved points; the zero mode of a spring is not elastic energy.
        let spring = match problem.boundary {
            Boundary::Periodic => solved.load.zero_stiffness * mean_displacement,
            Boundary::Free => 0.0,
        };
        // On a periodic grid the mean pressure works on the layer's mean displacement alone.
        let (elastic_part, shift) = match problem.boundary {
            Boundary::Periodic => (position.mean_pressure / scales.pressure, offset),
            Boundary::Free => (solved.held, offset),
        };
        let elastic_energy = 0.5
            * solved
                .gap
                .iter()
                .zip(lowered())
                .zip(&solved.elastic)
                .map(|((g, h), p)| (p - spring + elastic_part) * (g + h + shift))
                .sum::<f64>();

        // From here on these are the results, in their own places.
        let mut gap = problem.cut_to_surface(solved.gap);
        let mut pressure = problem.cut_to_surface(solved.elastic);
        let mut points = vec![PointState::Separated; gap.len()];
        let mut adhesive = 0.0;
        let mut strongest: f64 = 0.0;
        let negative_is_contact = matches!(problem.law, Law::LennardJones(_));
        for (i, (gap, pressure)) in gap.iter_mut().zip(&mut pressure).enumerate() {
            let g = open(*gap);
            let closed = if negative_is_contact {
                g < 0.0
            } else {
                g <= 0.0
            };
            let factor = setup.law_factor(i);
            let pulling = solved.law_factor.map_or(factor, |factors| factors[i]);
            let traction = pulling * law.traction(g);
            let support = if yields && *gap < 0.0 {
                Support::Indented
            } else if closed && !negative_is_contact {
                closed_support
            } else {
                Support::Law
            };
            *pressure = scales.pressure
                * net_pressure(support, *pressure + solved.held, traction, problem.hardness);
            if closed {
                points[i] = PointState::Contact;
            } else {
                strongest = strongest.max(traction);
                if g < law.range() {
                    points[i] = PointState::Attracted;
                }
            }
            adhesive += factor * law.energy(g);
            *gap = g * scales.length;
        }
        plastic_depth
            .iter_mut()
            .for_each(|depth| *depth *= scales.length);
        let contact = points.iter().filter(|&&p| p == PointState::Contact).count() as f64 / count;
        let attracted = points
            .iter()
            .filter(|&&p| p == PointState::Attracted)
            .count() as f64
            / count;
        let state = if contact > 0.0 {
            State::Contact
        } else if attracted > 0.0 || strongest > NEGLIGIBLE * law.peak_tension() {
            State::Attracted
        } else {
            State::Separated
        };
        let contact_corrected = problem.law.has_wall().then(|| {
            let edges = perimeter_edges(&points, problem.shape.surface, problem.boundary);
            contact - (PI - 1.0 + LN_2) / 24.0 * edges as f64 / count
        });
        let force = pressure.iter().fold(0.0, |sum, p| sum + p) * problem.grid.pixel_area();
        Evaluation {
            gap,
            pressure,
            displacement_offset: offset * scales.length - problem.height_origin,
            points,
            position,
            force,
            contact,
            attracted,
            contact_corrected,
            elastic_energy: elastic_energy * energy_unit,
            adhesive_energy: adhesive * energy_unit,
            state,
            plastic_depth,
        }
    }

    /// Values of a field in SI units, shape `[ny, nx]`, of a surface that began with these heights.
    pub fn field<'a>(&'a self, name: FieldName, heights: &'a [f64]) -> Cow<'a, [f64]> {
        match name {
            FieldName::Pressure => Cow::Borrowed(&self.pressure),
            FieldName::Gap => Cow::Borrowed(&self.gap),
            FieldName::Heights => self.heights(heights),
            FieldName::Displacement => {
                let heights = self.heights(heights);
                let points = self.gap.iter().zip(heights.iter());
                points
                    .map(|(g, h)| g + h + self.displacement_offset)
                    .collect()
            }
        }
    }

    /// The heights as plastic indentation has left them, m, of a surface that began with these.
    fn heights<'a>(&self, heights: &'a [f64]) -> Cow<'a, [f64]> {
        if self.plastic_depth.is_empty() {
            return Cow::Borrowed(heights);
        }
        let lowered = heights.iter().zip(&self.plastic_depth);
        lowered.map(|(height, depth)| height - depth).collect()
    }
}

/// Edges between a point in contact and a 4-neighbour that is not; they wrap on a periodic grid.
///
/// The staircase of a contact overestimates its area by (pi - 1 + ln 2)/24 of a pixel an edge
/// (Yastrebov, Anciaux & Molinari 2017, doi:10.1016/j.triboint.2017.04.023).
fn perimeter_edges(points: &[PointState], shape: [usize; 2], boundary: Boundary) -> usize {
    let [nx, ny] = shape;
    let touches = |x: usize, y: usize| points[y * nx + x] == PointState::Contact;
    let mut edges = 0;
    for y in 0..ny {
        for x in 0..nx {
            let here = touches(x, y);
            let wraps = boundary == Boundary::Periodic;
            if (x + 1 < nx || (wraps && nx > 1)) && here != touches((x + 1) % nx, y) {
                edges += 1;
            }
            if (y + 1 < ny || (wraps && ny > 1)) && here != touches(x, (y + 1) % ny) {
                edges += 1;
            }
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_wrap_on_a_periodic_grid_only() {
        let mut points = vec![PointState::Separated; 12];
        points[0] = PointState::Contact;
        assert_eq!(perimeter_edges(&points, [4, 3], Boundary::Periodic), 4);
        assert_eq!(perimeter_edges(&points, [4, 3], Boundary::Free), 2);
    }
}
