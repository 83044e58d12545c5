//! Where approach and force stand in a table, and how they follow from what an instrument records.

use std::path::Path;

use super::curve_file::name;
use super::error::FitError;
use crate::units::{Dimension, name_and_unit, quoted, unit_factor};

/// What a column of a force curve holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CurveQuantity {
    /// Approach of the probe, positive closer.
    Approach,
    /// Position of the base of the cantilever, positive closer: the approach and the deflection.
    Position,
    /// Force, positive in compression.
    Force,
    /// Deflection of the cantilever, positive in compression, as a length or in volts.
    Deflection,
    /// Time, for solids that relax.
    Time,
}

impl CurveQuantity {
    /// All of them.
    pub const ALL: [CurveQuantity; 5] = [
        CurveQuantity::Approach,
        CurveQuantity::Position,
        CurveQuantity::Force,
        CurveQuantity::Deflection,
        CurveQuantity::Time,
    ];

    /// Its name in the header and in calls.
    pub fn name(self) -> &'static str {
        match self {
            CurveQuantity::Approach => "approach",
            CurveQuantity::Position => "position",
            CurveQuantity::Force => "force",
            CurveQuantity::Deflection => "deflection",
            CurveQuantity::Time => "time",
        }
    }

    /// The one of a pair of which a curve needs one column.
    fn kind(self) -> CurveQuantity {
        match self {
            CurveQuantity::Approach | CurveQuantity::Position => CurveQuantity::Approach,
            CurveQuantity::Force | CurveQuantity::Deflection => CurveQuantity::Force,
            CurveQuantity::Time => CurveQuantity::Time,
        }
    }

    fn dimension(self) -> Dimension {
        match self {
            CurveQuantity::Force => Dimension::Force,
            CurveQuantity::Time => Dimension::Time,
            _ => Dimension::Length,
        }
    }

    /// A unit for messages.
    fn example(self) -> &'static str {
        match self {
            CurveQuantity::Force => "[nN]",
            _ => "[nm]",
        }
    }
}

/// The column of a quantity.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct ColumnChoice {
    /// What it holds.
    pub quantity: CurveQuantity,
    /// Its name in the header, without unit, or its number from 1.
    pub column: String,
    /// Its unit; `None` for that of the header, else SI (volts for a deflection with a sensitivity).
    pub unit: Option<String>,
    /// Whether the column has the opposite sign.
    pub reversed: bool,
}

impl ColumnChoice {
    /// Reads `QUANTITY=COLUMN`, as in `position=-Z piezo [um]` or `deflection=2 [V]`.
    ///
    /// # Errors
    /// What is wrong with the text, in words.
    pub fn parse(text: &str) -> Result<ColumnChoice, String> {
        let expected = "give QUANTITY=COLUMN, as in \"position=Z [um]\"; quantities are approach, position, force, deflection and time";
        let (quantity, column) = text.split_once('=').ok_or(expected)?;
        let quantity = CurveQuantity::ALL
            .into_iter()
            .find(|known| known.name().eq_ignore_ascii_case(quantity.trim()))
            .ok_or(expected)?;
        let column = column.trim();
        let reversed = column.starts_with('-');
        let (column, unit) = name_and_unit(column.trim_start_matches('-').trim());
        if column.is_empty() {
            return Err(expected.to_owned());
        }
        Ok(ColumnChoice {
            quantity,
            column: column.to_owned(),
            unit: unit.map(str::to_owned),
            reversed,
        })
    }
}

/// How a table is read: its columns, and what turns a deflection into a force.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct CurveColumns {
    /// Chosen columns; a quantity without choice has the column of its own name.
    pub choices: Vec<ColumnChoice>,
    /// Deflection of the cantilever per volt, m/V.
    pub sensitivity: Option<f64>,
    /// Spring constant of the cantilever, N/m.
    pub spring: Option<f64>,
}

/// The columns of a table that a curve is made of.
pub(super) struct Columns {
    /// Approach, or position.
    along: Column,
    /// Force, or deflection.
    across: Column,
    time: Option<Column>,
    /// Why a column of that name does not hold the time.
    pub(super) no_time: Option<String>,
    spring: Option<f64>,
}

/// Index of a column and the factor to SI.
struct Column {
    quantity: CurveQuantity,
    place: usize,
    factor: f64,
    in_volts: bool,
}

/// The header with the names of the columns.
pub(super) struct Head<'a> {
    pub(super) path: &'a Path,
    /// Its line, from 1.
    pub(super) line: usize,
    pub(super) names: Vec<&'a str>,
}

impl Head<'_> {
    /// The columns of a curve.
    ///
    /// # Errors
    /// A column that is missing or there twice, a wrong unit, and a spring constant or a sensitivity that is needed.
    pub(super) fn columns(&self, how: &CurveColumns) -> Result<Columns, FitError> {
        use CurveQuantity::{Approach, Deflection, Force, Position, Time};
        for (at, choice) in how.choices.iter().enumerate() {
            let mut others = how.choices[..at].iter().map(|other| other.quantity);
            if let Some(other) = others.find(|other| other.kind() == choice.quantity.kind()) {
                return Err(FitError::TwoChoices {
                    path: name(self.path),
                    first: other.name(),
                    second: choice.quantity.name(),
                });
            }
        }
        let first_of = |usual: CurveQuantity, other: CurveQuantity| {
            let column = match self.column(usual, how)? {
                Some(column) => Some(column),
                None => self.column(other, how)?,
            };
            column.ok_or_else(|| FitError::NoColumn {
                path: name(self.path),
                line: self.line,
                column: usual.name(),
                example: usual.example(),
                found: quoted(&self.names.join(", ")),
            })
        };
        let (along, across) = (first_of(Approach, Position)?, first_of(Force, Deflection)?);
        let needs_spring =
            along.quantity == Position && across.quantity == Force || across.quantity == Deflection;
        if needs_spring && how.spring.is_none() {
            let column = if across.quantity == Deflection {
                Deflection
            } else {
                Position
            };
            return Err(FitError::NoSpring {
                path: name(self.path),
                column: column.name(),
            });
        }
        // A column of the name that holds something else, such as a date, is not asked for.
        let is_chosen = how.choices.iter().any(|choice| choice.quantity == Time);
        let (time, no_time) = match self.column(Time, how) {
            Err(error) if is_chosen => return Err(error),
            Err(error) => (None, Some(error.to_string())),
            Ok(time) => (time, None),
        };
        Ok(Columns {
            along,
            across,
            time,
            no_time,
            spring: how.spring,
        })
    }

    /// The column of a quantity: the chosen one, else that of its name; `None` without either.
    fn column(
        &self,
        quantity: CurveQuantity,
        how: &CurveColumns,
    ) -> Result<Option<Column>, FitError> {
        let mut choices = how.choices.iter();
        let choice = choices.find(|choice| choice.quantity == quantity);
        // Where the other of a pair was chosen, a column that happens to have this name is not meant.
        let has_other = |choice: &ColumnChoice| choice.quantity.kind() == quantity.kind();
        if choice.is_none() && how.choices.iter().any(has_other) {
            return Ok(None);
        }
        let wanted = choice.map_or(quantity.name(), |choice| choice.column.as_str());
        let mut places = self
            .names
            .iter()
            .enumerate()
            .filter(|(_, text)| name_and_unit(text).0.eq_ignore_ascii_case(wanted));
        let (place, is_named) = match (places.next(), places.next(), choice) {
            (Some(_), Some(_), _) => {
                return Err(FitError::TwoColumns {
                    path: name(self.path),
                    line: self.line,
                    column: wanted.to_owned(),
                });
            }
            (Some((place, _)), None, _) => (place, true),
            (None, _, None) => return Ok(None),
            (None, _, Some(_)) => match wanted.parse::<usize>() {
                Ok(number) if (1..=self.names.len()).contains(&number) => (number - 1, true),
                _ => {
                    return Err(FitError::NoChosenColumn {
                        path: name(self.path),
                        line: self.line,
                        column: quoted(wanted),
                        quantity: quantity.name(),
                        found: quoted(&self.names.join(", ")),
                    });
                }
            },
        };
        let of_head = is_named
            .then(|| name_and_unit(self.names[place]).1)
            .flatten();
        let unit = choice.and_then(|choice| choice.unit.as_deref()).or(of_head);
        let (factor, in_volts) = self.factor(quantity, unit, how.sensitivity)?;
        let sign = if choice.is_some_and(|choice| choice.reversed) {
            -1.0
        } else {
            1.0
        };
        Ok(Some(Column {
            quantity,
            place,
            factor: sign * factor,
            in_volts,
        }))
    }

    /// SI value of one unit of a column, and whether that unit is one of voltage.
    fn factor(
        &self,
        quantity: CurveQuantity,
        unit: Option<&str>,
        sensitivity: Option<f64>,
    ) -> Result<(f64, bool), FitError> {
        let volts = match unit {
            _ if quantity != CurveQuantity::Deflection => None,
            None => sensitivity.map(|_| 1.0),
            Some(unit) => unit_factor(unit, Dimension::Voltage).ok(),
        };
        match (volts, sensitivity, unit) {
            (Some(volts), Some(sensitivity), _) => Ok((volts * sensitivity, true)),
            (Some(_), None, _) => Err(FitError::NoSensitivity {
                path: name(self.path),
            }),
            (None, _, None) => Ok((1.0, false)),
            (None, _, Some(unit)) => unit_factor(unit, quantity.dimension())
                .map(|factor| (factor, false))
                .map_err(|cause| FitError::Unit {
                    path: name(self.path),
                    line: self.line,
                    column: quantity.name(),
                    cause,
                }),
        }
    }
}

impl Columns {
    /// Whether a deflection in volts is read.
    pub(super) fn in_volts(&self) -> bool {
        self.across.in_volts
    }

    /// Whether positions are read in place of approaches.
    pub(super) fn has_positions(&self) -> bool {
        self.along.quantity == CurveQuantity::Position
    }

    /// Approach and force of a row; `None` where one of them is missing.
    pub(super) fn sample(
        &self,
        path: &Path,
        line: usize,
        cells: &[&str],
        separator: char,
    ) -> Result<Option<(f64, f64)>, FitError> {
        let along = self.along.value(path, line, cells, separator)?;
        let across = self.across.value(path, line, cells, separator)?;
        let (Some(along), Some(across)) = (along, across) else {
            return Ok(None);
        };
        let spring = self.spring.unwrap_or(f64::NAN);
        let force = match self.across.quantity {
            CurveQuantity::Deflection => spring * across,
            _ => across,
        };
        let approach = match (self.along.quantity, self.across.quantity) {
            (CurveQuantity::Position, CurveQuantity::Deflection) => along - across,
            (CurveQuantity::Position, _) => along - force / spring,
            _ => along,
        };
        Ok(Some((approach, force)))
    }

    /// Time of a row, s; `None` without such a column, NaN where it holds no number.
    pub(super) fn time(&self, cells: &[&str], separator: char) -> Option<f64> {
        let column = self.time.as_ref()?;
        let time = number(cells[column.place], separator).unwrap_or(f64::NAN);
        Some(column.factor * time)
    }
}

impl Column {
    /// The value in SI; `None` where it is missing.
    fn value(
        &self,
        path: &Path,
        line: usize,
        cells: &[&str],
        separator: char,
    ) -> Result<Option<f64>, FitError> {
        let text = cells[self.place];
        let missing = ["", "nan", "na", "n/a"];
        if missing.iter().any(|word| text.eq_ignore_ascii_case(word)) {
            return Ok(None);
        }
        number(text, separator)
            .map(|value| value * self.factor)
            .filter(|value| value.is_finite())
            .map(Some)
            .ok_or_else(|| FitError::NotANumber {
                path: name(path),
                line,
                column: self.quantity.name(),
                text: quoted(text),
            })
    }
}

/// A number, with a decimal comma if commas do not separate.
pub(super) fn number(text: &str, separator: char) -> Option<f64> {
    // `parse` accepts these words, but instruments do not mean them as numbers.
    let worded = |c: char| c.is_ascii_alphabetic() && !matches!(c, 'e' | 'E');
    if text.contains(worded) {
        return None;
    }
    if separator != ',' && text.matches(',').count() == 1 && !text.contains('.') {
        return text.replace(',', ".").parse().ok();
    }
    text.parse().ok()
}
