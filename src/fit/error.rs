//! Errors of force curves.

use std::io;

use super::curve_file::{LEAST_ROWS, MOST_BYTES};
use crate::theory::TheoryError;
use crate::units::UnitError;

/// Why a force curve gives no work of adhesion and no modulus.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// The file cannot be read.
    #[error("cannot read {path}: {cause}")]
    Unreadable {
        /// The file.
        path: String,
        /// The system's message.
        cause: io::Error,
    },
    /// A folder, device, pipe or socket in place of a file.
    #[error(
        "{path} is not a regular file (but a folder, a pipe or a device); save the curve to a file and name that"
    )]
    NotRegular {
        /// The path.
        path: String,
    },
    /// The file is too large.
    #[error("{path} has {bytes} bytes; a force curve may have {MOST_BYTES}, so thin its rows out")]
    TooLarge {
        /// The file.
        path: String,
        /// Its size.
        bytes: u64,
    },
    /// The file is not text.
    #[error("{path} is not text in UTF-8; save it as CSV with the columns approach and force")]
    NotText {
        /// The file.
        path: String,
    },
    /// A file of an instrument that cannot be read.
    #[error("{path} is not a whole {format} force curve: {what}")]
    Broken {
        /// The file.
        path: String,
        /// Name of the format.
        format: &'static str,
        /// What is wrong.
        what: String,
    },
    /// A relaxation time needs time.
    #[error(
        "{path}: a relaxation time needs the time of each row, increasing; name its column `time` (s) or with its unit, `time [ms]`"
    )]
    NoTime {
        /// The file.
        path: String,
    },
    /// The column of the time cannot be read.
    #[error("{reason}; a relaxation time needs the time of each row")]
    UnreadTime {
        /// The message of the column.
        reason: String,
    },
    /// Too few points of loading in contact for a relaxation time.
    #[error("{path}: {points} points of loading in contact, too few for a relaxation time")]
    NoLoading {
        /// The file.
        path: String,
        /// Points found.
        points: usize,
    },
    /// The header is missing.
    #[error(
        "{path} has no header; its first line must name the columns, as in `approach [nm], force [nN]`"
    )]
    NoHead {
        /// The file.
        path: String,
    },
    /// A column is missing.
    #[error(
        "{path}, line {line}: no column `{column}` among {found}; name it `{column}` (SI) or with its unit, `{column} {example}`"
    )]
    NoColumn {
        /// The file.
        path: String,
        /// The line of the head, from 1.
        line: usize,
        /// The name of the missing column.
        column: &'static str,
        /// A unit that it may have.
        example: &'static str,
        /// The columns present.
        found: String,
    },
    /// A chosen column is missing.
    #[error(
        "{path}, line {line}: no column {column} for the {quantity} among {found}; choose one of these, or a number from 1"
    )]
    NoChosenColumn {
        /// The file.
        path: String,
        /// The line of the head, from 1.
        line: usize,
        /// The name of the missing column, quoted.
        column: String,
        /// What it was chosen for.
        quantity: &'static str,
        /// The columns present.
        found: String,
    },
    /// Two columns are chosen for the same.
    #[error(
        "{path}: columns are chosen for {first} and for {second}, of which a curve has one; choose one of the two"
    )]
    TwoChoices {
        /// The file.
        path: String,
        /// The quantity that is chosen first.
        first: &'static str,
        /// The other one.
        second: &'static str,
    },
    /// A spring constant is needed.
    #[error(
        "{path}: the {column} needs the spring constant of the cantilever to give approach and force"
    )]
    NoSpring {
        /// The file.
        path: String,
        /// The column that needs it.
        column: &'static str,
    },
    /// The sensitivity of a deflection in volts is needed.
    #[error(
        "{path}: the deflection is in volts; give its sensitivity, the length that a volt is, as in 50 nm/V"
    )]
    NoSensitivity {
        /// The file.
        path: String,
    },
    /// A column occurs twice.
    #[error(
        "{path}, line {line}: there are two columns `{column}`; leave one, or name the other differently"
    )]
    TwoColumns {
        /// The file.
        path: String,
        /// The line of the head, from 1.
        line: usize,
        /// The column.
        column: String,
    },
    /// A unit in the header is unknown or of the wrong dimension.
    #[error("{path}, line {line}, column `{column}`: {cause}")]
    Unit {
        /// The file.
        path: String,
        /// The line of the head, from 1.
        line: usize,
        /// The column.
        column: &'static str,
        /// The reason.
        cause: UnitError,
    },
    /// A row has another number of values than the header has names.
    #[error(
        "{path}, line {line}: {found} values where the header names {expected} columns; decimal commas need semicolons or tabs between the columns"
    )]
    Ragged {
        /// The file.
        path: String,
        /// The line, from 1.
        line: usize,
        /// Values found.
        found: usize,
        /// Names in the header.
        expected: usize,
    },
    /// A value is not a number.
    #[error(
        "{path}, line {line}, column `{column}`: {text} is not a number; leave the cell empty where the value is missing"
    )]
    NotANumber {
        /// The file.
        path: String,
        /// The line, from 1.
        line: usize,
        /// The column.
        column: &'static str,
        /// Its text, quoted.
        text: String,
    },
    /// Numbers outside the supported magnitudes.
    #[error(
        "{path}, column `{column}`: its largest number is {largest:e}; it must be between 1e-30 and 1e30 in SI units: check the unit in the header"
    )]
    Extreme {
        /// The file.
        path: String,
        /// The column.
        column: &'static str,
        /// Its largest magnitude, SI.
        largest: f64,
    },
    /// Too few rows with both numbers.
    #[error("{path}: {rows} rows with an approach and a force, of {LEAST_ROWS} that a fit needs")]
    TooFewRows {
        /// The file.
        path: String,
        /// Rows found.
        rows: usize,
    },
    /// The approach or the force never changes.
    #[error("{path}: the {column} is the same in every row, so there is no curve to fit")]
    Constant {
        /// The file.
        path: String,
        /// The column.
        column: &'static str,
    },
    /// Too few points to know the slope of the baseline.
    #[error(
        "{path}: {points} points lie where no force acts, too few for the slope of the baseline; measure farther apart, or do not fit the slope"
    )]
    NoBaseline {
        /// The file.
        path: String,
        /// Points without force.
        points: usize,
    },
    /// The forces are noise.
    #[error("{path}: the forces are noise about the baseline, so that the curve shows no contact")]
    NoContact {
        /// The file.
        path: String,
    },
    /// No row is in compression.
    #[error(
        "{path}: no row is in compression (force > 0), so the modulus cannot be determined; force must be positive in compression, tension negative"
    )]
    NoCompression {
        /// The file.
        path: String,
    },
    /// The greatest force lies on the far side.
    #[error("{path}: {remedy}")]
    WrongWay {
        /// The file.
        path: String,
        /// What is reversed, and what to turn.
        remedy: &'static str,
    },
    /// No model fits the data.
    #[error("no model could be fitted to {path}: check units, signs and the tip")]
    NoFit {
        /// The file.
        path: String,
    },
    /// A model refuses the values.
    #[error(transparent)]
    Theory(#[from] TheoryError),
}
