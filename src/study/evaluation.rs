//! Evaluation of a solved state: fields in SI units, area fractions, energies.

use std::borrow::Cow;
use std::f64::consts::{LN_2, PI};

use super::control::{Controller, Position};
use super::row::State;
use super::setup::Setup;
use crate::backend::{BackendError, Share, host_fields};
use crate::grid::Boundary;
use crate::law::{Law, Support, imbalance, net_pressure};
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
    /// Of the edges that cut a surface off, what is closest there: contact or attraction.
    pub at_cut_edge: Option<PointState>,
    /// By how much the pressures miss the prescribed load, N or Pa, or the position that a spring holds, m; see
    /// [`Controller::missed`].
    pub missed: f64,
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
    /// Depth by which plastic indentation had lowered the heights before, over all solved points; `None`
    /// where there was none.
    pub plastic_depth: Option<&'a [f64]>,
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
    ///
    /// # Errors
    /// Another rank has ended.
    pub fn new(
        setup: &Setup,
        problem: &Problem,
        controller: &Controller,
        mut solved: Solved,
    ) -> Result<Self, BackendError> {
        let share = &problem.share;
        let (width, rows) = (problem.shape.points[0], share.rows().len());
        let scales = problem.scales;
        let law = setup.law.reduced(scales.length, scales.pressure);
        let closed_support = if setup.sums_attraction() {
            Support::WallAlone
        } else {
            Support::Wall
        };
        close_pressed(setup, problem, &mut solved, &law);
        // The heights as earlier indentation has left them.
        let (height_at, depths) = (problem.padded_height(), solved.plastic_depth.unwrap_or(&[]));
        let lowered = |i: usize| height_at(i) - depths.get(i).copied().unwrap_or(0.0);
        let [sum] = share.sums(rows, |row, [sum]| {
            for i in row * width..(row + 1) * width {
                *sum += solved.gap[i] + lowered(i);
            }
        });
        let mean_displacement = sum / problem.shape.len() as f64 + solved.mean_offset;
        let count = problem.grid.len() as f64;
        let yields = problem.hardness.is_some();
        let mut plastic_depth = match (yields, solved.plastic_depth) {
            (false, _) => Vec::new(),
            (true, None) => vec![0.0; share.surface_len()],
            (true, Some(before)) => problem.surface_part(before),
        };
        // Plastic indentation moves the bodies together and leaves no gap.
        for (depth, g) in plastic_depth
            .iter_mut()
            .zip(problem.on_surface(&solved.gap))
        {
            *depth -= g.min(0.0);
        }
        let open = |g: f64| if yields { g.max(0.0) } else { g };
        let (nx, surface_rows) = (problem.shape.surface[0], share.surface_rows().len());
        let [sum] = share.sums(surface_rows, |row, [sum]| {
            for g in &solved.gap[row * width..row * width + nx] {
                *sum += open(*g);
            }
        });
        let mean_gap = sum / count;
        let mean_depth = if yields {
            share.surface_sum_by(&plastic_depth, |depth| depth) / count
        } else {
            0.0
        };
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
        let [work] = share.sums(rows, |row, [sum]| {
            for i in row * width..(row + 1) * width {
                let p = solved.elastic[i];
                *sum += (p - spring + elastic_part) * (solved.gap[i] + lowered(i) + shift);
            }
        });
        let elastic_energy = 0.5 * work;

        // From here on these are the results, in their own places.
        let mut gap = problem.cut_to_surface(solved.gap);
        let mut pressure = problem.cut_to_surface(solved.elastic);
        let mut points = vec![PointState::Separated; gap.len()];
        let negative_is_contact = matches!(problem.law, Law::LennardJones(_));
        let pulling = |i: usize| match solved.law_factor {
            Some(factors) => factors[i],
            None => setup.law_factor(i),
        };
        let evaluate = |row: usize, [gap, pressure]: [&mut [f64]; 2], points: &mut [PointState]| {
            let mut adhesive = 0.0;
            let values = gap.iter_mut().zip(pressure).zip(points);
            for (x, ((gap, pressure), point)) in values.enumerate() {
                let i = row * nx + x;
                let g = open(*gap);
                let closed = if negative_is_contact {
                    g < 0.0
                } else {
                    g <= 0.0
                };
                let traction = pulling(i) * law.traction(g);
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
                    *point = PointState::Contact;
                } else if g < law.range() {
                    *point = PointState::Attracted;
                }
                adhesive += setup.law_factor(i) * law.energy(g);
                *gap = g * scales.length;
            }
            adhesive
        };
        let fields = [&mut gap[..], &mut pressure[..]];
        let [adhesive] =
            share.sums_changing(nx, fields, &mut points, |row, fields, points, sum| {
                sum[0] = evaluate(row, fields, points);
            });
        plastic_depth
            .iter_mut()
            .for_each(|depth| *depth *= scales.length);
        let of = |state: PointState| host_fields::count(&points, |&point| point == state);
        let [touching, pulled] = setup.cut_edges.reached(&points, share);
        let [contact, attracted, touching, pulled] = share.counts([
            of(PointState::Contact),
            of(PointState::Attracted),
            touching,
            pulled,
        ]);
        let at_cut_edge = match (touching, pulled) {
            (0, 0) => None,
            (0, _) => Some(PointState::Attracted),
            _ => Some(PointState::Contact),
        };
        let (contact, attracted) = (contact as f64 / count, attracted as f64 / count);
        // Out of contact.
        let strongest = || {
            let tractions = gap.iter().enumerate();
            let tractions = tractions.map(|(i, g)| pulling(i) * law.traction(g / scales.length));
            share.greatest(tractions.fold(0.0, f64::max))
        };
        let state = if contact > 0.0 {
            State::Contact
        } else if attracted > 0.0 || strongest() > NEGLIGIBLE * law.peak_tension() {
            State::Attracted
        } else {
            State::Separated
        };
        let contact_corrected = if problem.law.has_wall() {
            let edges = perimeter_edges(&points, share, problem.boundary)?;
            Some(contact - (PI - 1.0 + LN_2) / 24.0 * edges as f64 / count)
        } else {
            None
        };
        let force = share.surface_sum_by(&pressure, |p| p) * problem.grid.pixel_area();
        share.failed()?;
        let missed = match setup.sums_attraction() {
            true => 0.0,
            false => controller.missed(&position, force),
        };
        Ok(Evaluation {
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
            at_cut_edge,
            missed,
            plastic_depth,
        })
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

    /// Whether the values of a field lie ready, so that [`Evaluation::field`] makes none.
    pub fn holds(&self, name: FieldName) -> bool {
        match name {
            FieldName::Pressure | FieldName::Gap => true,
            FieldName::Heights => self.plastic_depth.is_empty(),
            FieldName::Displacement => false,
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

/// Closes the points whose gap is worth less than their reaction: such a point may be all that the residual leaves.
/// It is in contact. Open, it would carry the law's tension alone, and its reaction would be missing from the force.
fn close_pressed(setup: &Setup, problem: &Problem, solved: &mut Solved, law: &Law) {
    if !problem.law.has_wall() {
        return;
    }
    let stiffest = problem.stiffness_max();
    let sums_attraction = setup.sums_attraction();
    let (width, nx) = (problem.shape.points[0], problem.shape.surface[0]);
    let (held, factors) = (solved.held, solved.law_factor);
    let elastic = &solved.elastic;
    let surface = problem.share.surface_rows().len() * width;
    host_fields::change_rows(&mut solved.gap[..surface], width, |row, gap| {
        let elastic = &elastic[row * width..];
        for (x, (g, elastic)) in gap[..nx].iter_mut().zip(elastic).enumerate() {
            if *g <= 0.0 {
                continue;
            }
            let i = row * nx + x;
            let factor = factors.map_or(setup.law_factor(i), |factors| factors[i]);
            let traction = match sums_attraction {
                true => 0.0,
                false => factor * law.traction(*g),
            };
            if imbalance(elastic + held, traction) > *g * stiffest {
                *g = 0.0;
            }
        }
    });
}

/// Edges between a point in contact and a 4-neighbour that is not; they wrap on a periodic grid.
///
/// The staircase of a contact overestimates its area by (pi - 1 + ln 2)/24 of a pixel an edge
/// (Yastrebov, Anciaux & Molinari 2017, doi:10.1016/j.triboint.2017.04.023).
///
/// # Errors
/// Another rank has ended.
fn perimeter_edges(
    points: &[PointState],
    share: &Share,
    boundary: Boundary,
) -> Result<usize, BackendError> {
    let [nx, ny] = share.surface();
    let rows = share.surface_rows();
    let wraps = boundary == Boundary::Periodic;
    // All that others want of these rows is the first one.
    let first: Vec<u8> = points[..nx.min(points.len())]
        .iter()
        .map(|point| *point as u8)
        .collect();
    let after = share.surface_row_after(&first)?;
    let touches = |x: usize, y: usize| points[y * nx + x] == PointState::Contact;
    let touches_after = |x: usize| after[x] == PointState::Contact as u8;
    let edges_of_row = |y: usize| {
        let mut edges = 0;
        let is_followed = rows.start + y + 1 < ny || (wraps && ny > 1);
        for x in 0..nx {
            let here = touches(x, y);
            if (x + 1 < nx || (wraps && nx > 1)) && here != touches((x + 1) % nx, y) {
                edges += 1;
            }
            let below = || match y + 1 < rows.len() {
                true => touches(x, y + 1),
                false => touches_after(x),
            };
            if is_followed && here != below() {
                edges += 1;
            }
        }
        edges
    };
    let edges = host_fields::count_in_rows(rows.len(), edges_of_row);
    let [edges] = share.counts([edges]);
    Ok(edges)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::Shape;

    #[test]
    fn edges_wrap_on_a_periodic_grid_only() {
        let mut points = vec![PointState::Separated; 12];
        points[0] = PointState::Contact;
        let share = Share::whole(Shape::whole(4, 3));
        let edges = |boundary| perimeter_edges(&points, &share, boundary).expect("one process");
        assert_eq!(edges(Boundary::Periodic), 4);
        assert_eq!(edges(Boundary::Free), 2);
    }
}
