//! Jumps: steps that dissipate energy because the surfaces left one equilibrium for another.

use super::evaluation::{Evaluation, PointState};
use super::row::{State, StepRow};
use super::setup::Setup;
use crate::scene::Control;

/// A step is a jump if it dissipates more than this share of w times the area that changed state.
const DISSIPATED_SHARE: f64 = 0.05;
/// A path is closed if its ends agree to this share of its span.
const CLOSED: f64 = 1e-9;

/// Which way a step jumped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Jump {
    /// More area sticks after it.
    In,
    /// Less area sticks after it.
    Off,
}

/// Watches the steps of a path for jumps.
pub struct Jumps {
    /// Work of adhesion, J/m^2; `None` where nothing can jump.
    work: Option<f64>,
    pixel_area: f64,
    control: Control,
    /// Factors on the law's tension.
    law_factor: Option<Vec<f64>>,
    before: Option<Before>,
}

struct Before {
    row: StepRow,
    points: Option<Vec<PointState>>,
}

impl Jumps {
    /// A watch for the steps of a setup. Without adhesion nothing jumps, and with attraction summed
    /// afterwards loading and unloading are the same curve.
    pub fn new(setup: &Setup) -> Self {
        // Nor can a jump be told from what a relaxing solid dissipates in the same step.
        let relaxes = !setup.scene.solid.relaxation.is_empty();
        // Or an edge that recedes at a rate.
        let adhesion = setup.scene.adhesion.as_ref();
        let rated = adhesion.is_some_and(|adhesion| adhesion.rate.is_some());
        let adhesive = setup.law.is_adhesive() && !setup.dmt && !relaxes && !rated;
        Jumps {
            work: adhesive.then(|| setup.law.work_of_adhesion()),
            pixel_area: setup.surface.grid.pixel_area(),
            control: setup.scene.loading.control,
            law_factor: setup.surface.adhesion_map.clone(),
            before: None,
        }
    }

    /// Takes the last of the steps that another process did.
    pub fn go_on(&mut self, row: &StepRow, points: Option<Vec<PointState>>) {
        if self.work.is_some() {
            self.before = Some(Before {
                row: row.clone(),
                points,
            });
        }
    }

    /// What the points did in the last step, where it had fields.
    pub fn points(&self) -> Option<&[PointState]> {
        self.before.as_ref()?.points.as_deref()
    }

    /// Takes the next step and says whether it jumped.
    pub fn step(&mut self, row: &StepRow, evaluation: Option<&Evaluation>) -> Option<Jump> {
        let work = self.work?;
        let points = evaluation.map(|evaluation| evaluation.points.clone());
        let before = self.before.replace(Before {
            row: row.clone(),
            points,
        })?;
        let now = self.before.as_ref()?;
        let stuck = |row: &StepRow| row.contact_area_fraction + row.attractive_area_fraction;
        let way = if stuck(row) > stuck(&before.row)
            || (stuck(row) == stuck(&before.row)
                && row.contact_area_fraction > before.row.contact_area_fraction)
        {
            Jump::In
        } else {
            Jump::Off
        };
        match (&before.points, &now.points) {
            (Some(old), Some(new)) => {
                // Points that changed, each by how strongly it sticks.
                let sticks = |point: usize| self.law_factor.as_ref().map_or(1.0, |map| map[point]);
                let changed = old
                    .iter()
                    .zip(new)
                    .enumerate()
                    .filter(|(_, (a, b))| a != b)
                    .map(|(point, _)| sticks(point))
                    .sum::<f64>();
                let dissipated =
                    dissipation(&before.row, row)? - quadrature_error(&before.row, row)?;
                let threshold = DISSIPATED_SHARE * work * changed * self.pixel_area;
                (changed > 0.0 && dissipated > threshold).then_some(way)
            }
            // Under a prescribed load the parted surfaces have no position, so no energy either:
            // parting and meeting are jumps wherever something stuck.
            (Some(_), None) => (before.row.state != State::Separated).then_some(Jump::Off),
            (None, Some(_)) => (row.state != State::Separated).then_some(Jump::In),
            (None, None) => None,
        }
    }

    /// Energy dissipated over a path of approach or mean gap that returns to its start.
    pub fn hysteresis(&self, rows: &[StepRow]) -> Option<f64> {
        let place = |row: &StepRow| match self.control {
            Control::Approach => row.approach,
            Control::MeanGap => row.mean_gap.map(|gap| -gap),
            Control::Pressure | Control::Force => None,
        };
        let (first, last) = (place(rows.first()?)?, place(rows.last()?)?);
        let places: Option<Vec<f64>> = rows.iter().map(place).collect();
        let places = places?;
        let span = places.iter().copied().fold(f64::NEG_INFINITY, f64::max)
            - places.iter().copied().fold(f64::INFINITY, f64::min);
        if rows.len() < 3
            || !rows.iter().all(|row| row.converged)
            || (last - first).abs() > CLOSED * span
        {
            return None;
        }
        Some(
            rows.windows(2)
                .zip(places.windows(2))
                .map(|(row, place)| 0.5 * (row[0].force + row[1].force) * (place[1] - place[0]))
                .sum(),
        )
    }
}

/// What the straight line between two steps may be off by, J, where the force follows a smooth curve.
///
/// A sixth of the change of force times the way is the trapezium's error for a parabola from its
/// vertex; the curves of spheres and rough surfaces bend less. It vanishes with the square of the step,
/// a jump does not.
fn quadrature_error(before: &StepRow, row: &StepRow) -> Option<f64> {
    let moved = row.approach? - before.approach?;
    Some(((row.force - before.force) * moved).abs() / 6.0)
}

/// Work done on the surfaces in a step less what they store and what flows, J.
pub fn dissipation(before: &StepRow, row: &StepRow) -> Option<f64> {
    let moved = row.approach? - before.approach?;
    let work = 0.5 * (before.force + row.force) * moved;
    let stored =
        row.elastic_energy + row.adhesive_energy - before.elastic_energy - before.adhesive_energy;
    // What has flowed has cost its own share, which no jump took.
    let flowed = row.plastic_energy.unwrap_or(0.0) - before.plastic_energy.unwrap_or(0.0);
    Some(work - stored - flowed)
}
