//! The models, and what an entry of the list is made of.

use super::parameters::Parameter;
use super::values::Values;
use super::{advise, dmt, lennard_jones, map, rough, soft, spheres, summits, waves};
use crate::cli::Failure;

/// An analytic model that can be tabulated.
pub(super) struct Model {
    /// As it is called on the command line.
    pub name: &'static str,
    /// What it describes, in one line.
    pub about: &'static str,
    /// Authors and year.
    pub source: &'static str,
    /// What it takes, in the order in which it is listed, in groups that models share.
    pub parameters: &'static [&'static [Parameter]],
    /// What it gives: names, with SI units in brackets but for numbers without one and for words.
    pub columns: &'static str,
    /// Parameters of a call that works, for the help.
    pub example: &'static str,
    /// Fills the table.
    pub table: fn(&Values) -> Result<Table, Failure>,
}

impl Model {
    /// All that it takes.
    pub fn parameters(&self) -> impl Iterator<Item = &'static Parameter> + Clone {
        self.parameters.iter().copied().flatten()
    }
}

/// Rows of a model, in SI, and what else it has to say.
#[derive(Default)]
pub(super) struct Table {
    /// One cell for each of the model's columns.
    pub rows: Vec<Vec<Cell>>,
    /// Comments above the table, such as `pull_off_force = -1.5e-9 N`.
    pub notes: Vec<String>,
}

impl Table {
    /// A table of a row for each of `places`.
    pub fn over(
        places: &[f64],
        row: impl FnMut(f64) -> Result<Vec<Cell>, Failure>,
    ) -> Result<Self, Failure> {
        Ok(Table {
            rows: places.iter().copied().map(row).collect::<Result<_, _>>()?,
            notes: Vec::new(),
        })
    }

    /// Adds a named number to the comments.
    pub fn note(&mut self, name: &str, value: f64, unit: &str) {
        let space = if unit.is_empty() { "" } else { " " };
        self.notes.push(if value.is_finite() {
            // Adding zero makes a minus zero a plain one.
            format!("{name} = {:?}{space}{unit}", value + 0.0)
        } else {
            format!("{name}: beyond the range of numbers")
        });
    }
}

/// A row of numbers.
pub(super) fn numbers<const COLUMNS: usize>(row: [f64; COLUMNS]) -> Result<Vec<Cell>, Failure> {
    Ok(row.map(Cell::Number).to_vec())
}

/// One value of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cell {
    /// A number in SI; empty in the table unless it is finite.
    Number(f64),
    /// A word.
    Word(&'static str),
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Cell::Number(number)
    }
}

impl From<&'static str> for Cell {
    fn from(word: &'static str) -> Self {
        Cell::Word(word)
    }
}

/// Every model, single contacts first, in the order in which they are listed.
pub(super) static MODELS: &[Model] = &[
    spheres::HERTZ,
    spheres::CONE,
    spheres::FLAT_PUNCH,
    dmt::BRADLEY,
    dmt::DERJAGUIN,
    dmt::DMT_T,
    dmt::IDMT_T,
    dmt::DMT_F,
    dmt::DMT_M,
    soft::JKR,
    soft::MAUGIS_DUGDALE,
    lennard_jones::LENNARD_JONES_SPHERE,
    map::TABOR_MAP,
    advise::ADVISE,
    waves::WESTERGAARD,
    waves::WAVY_ADHESIVE,
    summits::GW,
    summits::GW_M,
    summits::FULLER_TABOR,
    rough::PERSSON,
    rough::BAM,
    rough::PASTEWKA_ROBBINS,
];
