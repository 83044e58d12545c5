//! One finished step, as it is written to `curve.csv`.

use crate::scene::Scene;

/// Contact state of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Something touches.
    Contact,
    /// Nothing touches, but the surfaces attract.
    Attracted,
    /// Nothing touches and nothing attracts, or no equilibrium carries the load.
    Separated,
}

impl State {
    /// The word written to files.
    pub fn name(self) -> &'static str {
        match self {
            State::Contact => "contact",
            State::Attracted => "attracted",
            State::Separated => "separated",
        }
    }

    /// The state of a word that [`State::name`] gave.
    pub fn from_name(name: &str) -> Option<State> {
        [State::Contact, State::Attracted, State::Separated]
            .into_iter()
            .find(|state| state.name() == name)
    }
}

/// One row of `curve.csv`, SI units; `None` is written as an empty cell.
#[derive(Clone, Debug, PartialEq)]
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
    /// Friction force of the shear strength over the area in contact, N; `None` without friction.
    pub friction_force: Option<f64>,
    /// Energy that plastic flow has dissipated since the path began, J; `None` without a hardness.
    pub plastic_energy: Option<f64>,
    /// What the contact conducts, W/K; `None` without conductance, where the surfaces are closed
    /// everywhere, or where the step did not converge.
    pub conductance: Option<f64>,
    /// Volume that a length of sliding wears off, m^3 per m; `None` without wear.
    pub wear_rate: Option<f64>,
}

/// A column that `curve.csv` has behind the others where an effect asks for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// Friction force.
    FrictionForce,
    /// Energy that plastic flow has dissipated.
    PlasticEnergy,
    /// Conductance.
    Conductance,
    /// Volume worn off for each length of sliding.
    WearRate,
}

impl Column {
    /// Those that a scene asks for, in their order.
    pub fn of(scene: &Scene) -> Vec<Column> {
        let mut columns = Vec::new();
        if scene.friction.is_some() {
            columns.push(Column::FrictionForce);
        }
        if scene.solid.hardness.is_some() {
            columns.push(Column::PlasticEnergy);
        }
        if scene.conductance.is_some() {
            columns.push(Column::Conductance);
        }
        if scene.wear.is_some() {
            columns.push(Column::WearRate);
        }
        columns
    }

    /// Its name in the head.
    pub fn name(self) -> &'static str {
        match self {
            Column::FrictionForce => "friction_force",
            Column::PlasticEnergy => "plastic_energy",
            Column::Conductance => "conductance",
            Column::WearRate => "wear_rate",
        }
    }

    /// Its value in a row.
    pub fn value(self, row: &StepRow) -> Option<f64> {
        match self {
            Column::FrictionForce => row.friction_force,
            Column::PlasticEnergy => row.plastic_energy,
            Column::Conductance => row.conductance,
            Column::WearRate => row.wear_rate,
        }
    }

    /// Sets its value in a row.
    pub fn set(self, row: &mut StepRow, value: Option<f64>) {
        match self {
            Column::FrictionForce => row.friction_force = value,
            Column::PlasticEnergy => row.plastic_energy = value,
            Column::Conductance => row.conductance = value,
            Column::WearRate => row.wear_rate = value,
        }
    }
}
