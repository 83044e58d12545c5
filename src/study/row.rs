//! One finished step, as it is written to `curve.csv`.

use serde::Deserialize;

use crate::scene::{Control, LoadingScene};

/// Contact state of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum State {
    /// Something touches.
    Contact,
    /// Nothing touches, but the surfaces attract.
    Attracted,
    /// Nothing touches and nothing attracts, or no equilibrium carries the load.
    Separated,
    /// No contact has the prescribed value, as an approach beyond full contact.
    Unknown,
}

impl State {
    /// The word written to files.
    pub fn name(self) -> &'static str {
        match self {
            State::Contact => "contact",
            State::Attracted => "attracted",
            State::Separated => "separated",
            State::Unknown => "unknown",
        }
    }
}

/// One row of `curve.csv`, SI units; `None` is written as an empty cell. What is not a number is unknown: no contact has the prescribed
/// value, and its [`state`](StepRow::state) says so.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[non_exhaustive]
pub struct StepRow {
    /// Number of the step, from 1.
    pub step: usize,
    /// Time at the end of the step, s, where the path has durations.
    pub time: Option<f64>,
    /// Rigid displacement towards the solid since first touch, m.
    pub approach: Option<f64>,
    /// Mean of the gap over the grid, m.
    pub mean_gap: Option<f64>,
    /// Net force, N, positive in compression.
    pub force: f64,
    /// Force over nominal area, Pa.
    pub mean_pressure: f64,
    /// Share of the nominal area in contact.
    pub contact_area_fraction: f64,
    /// Share of the nominal area not in contact with a gap below the range.
    pub attractive_area_fraction: f64,
    /// Elastic energy, J.
    pub elastic_energy: f64,
    /// Energy of adhesion, J (not positive).
    pub adhesive_energy: f64,
    /// Iterations of the solver.
    pub iterations: usize,
    /// The stopping measure, evaluated afresh at the end.
    pub residual: f64,
    /// Whether the residual meets the tolerance.
    pub converged: bool,
    /// Wall-clock seconds of the step.
    pub seconds: f64,
    /// Contact share with the pixel staircase of its perimeter taken off; `None` for Lennard-Jones.
    pub contact_area_fraction_corrected: Option<f64>,
    /// Contact state.
    pub state: State,
    /// Values of the effects' columns, in their order.
    #[serde(skip)]
    pub columns: Vec<(Column, Option<f64>)>,
}

/// The row of the greatest contact area, of steps that converged; where none did, of those that were begun.
pub(crate) fn largest_contact(rows: &[StepRow]) -> Option<&StepRow> {
    let area = |row: &&StepRow| row.contact_area_fraction;
    let largest = |of: fn(&&StepRow) -> bool| {
        let rows = rows.iter().filter(of);
        rows.max_by(|a, b| area(a).total_cmp(&area(b)))
    };
    largest(|row| row.converged).or_else(|| largest(|row| row.has_solution()))
}

impl StepRow {
    /// Whether the step has a solution; false for a prescribed value that no contact can have.
    pub(crate) fn has_solution(&self) -> bool {
        self.converged || self.approach.is_some()
    }

    /// The state and whether it converged, in words.
    #[cfg(feature = "images")]
    pub(crate) fn state_words(&self) -> String {
        match (self.converged, self.has_solution()) {
            (true, _) => self.state.name().to_owned(),
            (false, true) => format!("{}, not converged", self.state.name()),
            (false, false) => "no solution".to_owned(),
        }
    }

    /// The value of a column that an effect adds; `None` where it is not there or has no value.
    pub fn column(&self, name: &str) -> Option<f64> {
        let found = self.columns.iter().find(|(column, _)| column.name == name);
        found.and_then(|(_, value)| *value)
    }

    /// How far a prescribed position brings the surfaces together, m: the approach, or the mean gap with the other sign. `None` under a
    /// load, and in a step without a position.
    pub(crate) fn place(&self, control: Control) -> Option<f64> {
        match control {
            Control::Approach => self.approach,
            Control::MeanGap => self.mean_gap.map(|gap| -gap),
            Control::Pressure | Control::Force => None,
        }
    }

    /// The same of what the path prescribes, which with a spring is its far end: the surfaces may stay where they are as it goes on.
    pub(crate) fn prescribed_place(&self, loading: &LoadingScene) -> Option<f64> {
        Some(self.place(loading.control)? + loading.stretched(self.force))
    }

    /// Energy that the solid has dissipated since the path began, J.
    pub(super) fn dissipated_energy(&self) -> f64 {
        let dissipated = self
            .columns
            .iter()
            .filter(|(column, _)| column.is_dissipated_energy);
        dissipated.filter_map(|(_, value)| *value).sum()
    }
}

/// A column that `curve.csv` has behind the others where an effect asks for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name in the head.
    pub(crate) name: &'static str,
    /// Its unit.
    pub(crate) unit: &'static str,
    /// Its place among the columns of effects. A new one stands behind all that there were, so that
    /// tables of before keep their order.
    pub(crate) place: usize,
    /// Whether it holds energy that the solid has dissipated since the path began, J.
    pub(crate) is_dissipated_energy: bool,
}

impl Column {
    /// A column of that name and unit at a place among those of effects.
    pub(crate) const fn new(name: &'static str, unit: &'static str, place: usize) -> Column {
        Column {
            name,
            unit,
            place,
            is_dissipated_energy: false,
        }
    }

    /// Its name in the head.
    pub fn name(self) -> &'static str {
        self.name
    }

    /// Its value in a row.
    pub fn value(self, row: &StepRow) -> Option<f64> {
        row.column(self.name)
    }

    /// Sets its value in a row.
    pub fn set(self, row: &mut StepRow, value: Option<f64>) {
        let same = |(column, _): &&mut (Column, _)| column.name == self.name;
        match row.columns.iter_mut().find(same) {
            Some((_, old)) => *old = value,
            None => row.columns.push((self, value)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(step: usize, contact: f64, converged: bool) -> StepRow {
        StepRow {
            step,
            time: None,
            approach: Some(0.0),
            mean_gap: Some(0.0),
            force: 0.0,
            mean_pressure: 0.0,
            contact_area_fraction: contact,
            attractive_area_fraction: 0.0,
            elastic_energy: 0.0,
            adhesive_energy: 0.0,
            iterations: 1,
            residual: 0.0,
            converged,
            seconds: 0.0,
            contact_area_fraction_corrected: None,
            state: State::Contact,
            columns: Vec::new(),
        }
    }

    /// The contact of a step that did not converge is no result of a run, unless there is no other.
    #[test]
    fn the_largest_contact_is_one_that_converged() {
        let largest = |rows: &[StepRow]| largest_contact(rows).map(|row| row.step);
        let rows = [row(1, 0.1, true), row(2, 0.2, true), row(3, 0.9, false)];
        assert_eq!(largest(&rows), Some(2));
        assert_eq!(largest(&rows[2..]), Some(3));
        let unreachable = StepRow {
            approach: None,
            ..row(1, 0.0, false)
        };
        assert_eq!(largest(&[unreachable]), None);
        assert_eq!(largest(&[]), None);
    }
}
