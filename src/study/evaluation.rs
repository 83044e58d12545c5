//! Evaluation of a solved state: fields in SI units, area fractions, energies.

use std::borrow::Cow;

use super::control::{Controller, Position};
use super::perimeter::{Perimeter, STAIRCASE};
use super::row::State;
use super::setup::Setup;
use crate::backend::long_field::LongField;
use crate::backend::{BackendError, host_fields};
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
    pub gap: LongField<f64>,
    /// Net pressure, Pa, positive in compression, shape `[ny, nx]`.
    pub pressure: LongField<f64>,
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
    /// Contact share less the pixel staircase, where a wall makes contact sharp; with a hardness at least what its pressures need.
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
    pub gap: LongField<f64>,
    /// K*(g + h). The net pressure takes its place.
    pub elastic: LongField<f64>,
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
        let width = problem.shape.points[0];
        let scales = problem.scales;
        let law = setup.law.reduced(scales.length, scales.pressure);
        let closed_support = if setup.sums_attraction() {
            Support::WallAlone
        } else {
            Support::Wall
        };
        // The heights as earlier indentation has left them.
        let depths = solved.plastic_depth.unwrap_or(&[]);
        let lowered = |row: usize| {
            let height_at = problem.padded_row(row);
            let depths = depths.get(row * width..).unwrap_or(&[]);
            move |x: usize| height_at(x) - depths.get(x).copied().unwrap_or(0.0)
        };
        let yields = problem.hardness.is_some();
        let open = |g: f64| if yields { g.max(0.0) } else { g };
        let (nx, surface_rows) = (problem.shape.surface[0], share.surface_rows().len());
        let closing = Closing::new(setup, problem, &solved, &law);
        let fields = [&mut solved.gap[..], &mut solved.elastic[..]];
        let none: &mut [PointState] = &mut [];
        let [sum, open_sum] = share.sums_changing(
            (width, fields),
            (nx, none),
            |row, [gap, elastic], _, [sum, open_sum]| {
                if row < surface_rows {
                    closing.close(row * nx, &mut gap[..nx], &elastic[..nx]);
                    gap[..nx].iter().for_each(|g| *open_sum += open(*g));
                }
                let height_at = lowered(row);
                for (x, g) in gap.iter().enumerate() {
                    *sum += g + height_at(x);
                }
            },
        );
        let mean_displacement = sum / problem.shape.len() as f64 + solved.mean_offset;
        let count = problem.grid.len() as f64;
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
        let mean_gap = open_sum / count;
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
        let mut points = host_fields::filled(share.surface_len(), PointState::Separated);
        let negative_is_contact = matches!(problem.law, Law::LennardJones(_));
        let pulling = |i: usize| match solved.law_factor {
            Some(factors) => factors[i],
            None => setup.law_factor(i),
        };
        let evaluate = |i: usize, gap: &mut f64, pressure: &mut f64, point: &mut PointState| {
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
            } else if g < law.range() && pulling(i) > 0.0 {
                *point = PointState::Attracted;
            }
            *gap = g * scales.length;
            setup.law_factor(i) * law.energy(g)
        };
        // The work of all solved points, then the results of those of the surface, in the places of what was solved.
        let fields = [&mut solved.gap[..], &mut solved.elastic[..]];
        let [work, adhesive, force, contact, attracted] = share.sums_changing(
            (width, fields),
            (nx, &mut points),
            |row, [gap, pressure], points, [work, adhesive, force, contact, attracted]| {
                let height_at = lowered(row);
                for (x, (g, p)) in gap.iter().zip(&*pressure).enumerate() {
                    *work += (p - spring + elastic_part) * (g + height_at(x) + shift);
                }
                let values = gap.iter_mut().zip(pressure);
                for (x, ((gap, pressure), point)) in values.zip(points).enumerate() {
                    *adhesive += evaluate(row * nx + x, gap, pressure, point);
                    *force += *pressure;
                    *contact += f64::from(*point == PointState::Contact);
                    *attracted += f64::from(*point == PointState::Attracted);
                }
            },
        );
        let elastic_energy = 0.5 * work;
        let mut gap = problem.cut_to_surface(solved.gap);
        let mut pressure = problem.cut_to_surface(solved.elastic);
        let perimeter = Perimeter::new(&points, share, problem.boundary)?;
        // Attraction that is summed over the gap acts on the part of a pixel in contact that only the staircase closes.
        let at_edges = if setup.sums_attraction() {
            let tension = law.traction(0.0) * scales.pressure;
            let none: &mut [()] = &mut [];
            let [sum] = share.sums_changing(
                (nx, [&mut pressure, &mut gap]),
                (nx, none),
                |row, [pressure, _], _, [sum]| {
                    for (x, pressure) in pressure.iter_mut().enumerate() {
                        let open = STAIRCASE * perimeter.edges_of(x, row) as f64;
                        let pull = open * pulling(row * nx + x) * tension;
                        *pressure -= pull;
                        *sum += pull;
                    }
                },
            );
            sum
        } else {
            0.0
        };
        let force = (force - at_edges) * problem.grid.pixel_area();
        plastic_depth
            .iter_mut()
            .for_each(|depth| *depth *= scales.length);
        let [touching, pulled] = share.counts(setup.cut_edges.reached(&points, share));
        let at_cut_edge = match (touching, pulled) {
            (0, 0) => None,
            (0, _) => Some(PointState::Attracted),
            _ => Some(PointState::Contact),
        };
        let (contact, attracted) = (contact / count, attracted / count);
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
            let corrected = contact - STAIRCASE * perimeter.edges() as f64 / count;
            // No point carries more than the hardness: the area that the pressures need at least is no staircase.
            let needed = problem.hardness.map_or(0.0, |hardness| {
                let carried = share.surface_sum_by(&pressure, |pressure| pressure.max(0.0));
                carried / (hardness * scales.pressure * count)
            });
            Some(corrected.max(needed.min(contact)))
        } else {
            None
        };
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
struct Closing<'a> {
    setup: &'a Setup,
    law: &'a Law,
    /// Without a wall no point has a reaction.
    has_wall: bool,
    sums_attraction: bool,
    stiffest: f64,
    held: f64,
    factors: Option<&'a [f64]>,
}

impl<'a> Closing<'a> {
    fn new(setup: &'a Setup, problem: &Problem, solved: &Solved<'a>, law: &'a Law) -> Self {
        Closing {
            setup,
            law,
            has_wall: problem.law.has_wall(),
            sums_attraction: setup.sums_attraction(),
            stiffest: problem.stiffness_max(),
            held: solved.held,
            factors: solved.law_factor,
        }
    }

    /// Those of a row of the surface, whose first point is given.
    fn close(&self, first: usize, gap: &mut [f64], elastic: &[f64]) {
        if !self.has_wall {
            return;
        }
        for (i, (g, elastic)) in (first..).zip(gap.iter_mut().zip(elastic)) {
            if *g <= 0.0 {
                continue;
            }
            let factor = self
                .factors
                .map_or(self.setup.law_factor(i), |factors| factors[i]);
            let traction = match self.sums_attraction {
                true => 0.0,
                false => factor * self.law.traction(*g),
            };
            if imbalance(elastic + self.held, traction) > *g * self.stiffest {
                *g = 0.0;
            }
        }
    }
}
