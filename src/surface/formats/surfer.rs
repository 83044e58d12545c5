//! Golden Software's Surfer grids (.grd): text (DSAA), 6 binary (DSBB), 7 binary (DSRB).
//!
//! Rows run along x and start at the least y. No unit is stated: coordinates have that of the
//! heights.
//!
//! # Source
//! Golden Software, Surfer user's guide, "ASCII grid file format", "Surfer 6 grid file format" and
//! "Surfer 7 grid file format".

use super::bytes::{Bytes, checked_shape, latin_1, refuse_short_text, with_capacity};
use crate::surface::error::FileError;
use crate::surface::matrix::{Matrix, Size};

/// First bytes of the three forms.
pub(super) const TEXT: &[u8] = b"DSAA";
pub(super) const BINARY: &[u8] = b"DSBB";
pub(super) const BINARY_7: &[u8] = b"DSRB";

/// Least value that marks a missing node: 1.70141e38, to the digits that every form keeps.
const BLANK: f64 = 1.7014e38;

/// Name of the format in messages.
const FORMAT: &str = ".grd";

/// Reads a grid of any of the three forms.
pub(super) fn read(bytes: &[u8]) -> Result<Matrix, FileError> {
    match bytes.get(..4) {
        Some(TEXT) => read_text(bytes),
        Some(BINARY) => read_binary(bytes),
        _ => read_binary_7(bytes),
    }
}

/// Least and greatest x and y, then those of the heights, which are not needed.
fn read_text(bytes: &[u8]) -> Result<Matrix, FileError> {
    let text = latin_1(bytes);
    let mut words = text.lines().enumerate().flat_map(|(index, line)| {
        line.split_ascii_whitespace()
            .map(move |word| (index + 1, word))
    });
    words.next();
    let mut line_now = 1;
    let mut number = |what: &str| -> Result<f64, FileError> {
        let (line, word) = words.next().ok_or_else(|| FileError::BrokenText {
            format: FORMAT,
            line: line_now,
            what: format!("the file ends before {what}"),
        })?;
        line_now = line;
        word.parse().map_err(|_| FileError::BrokenText {
            format: FORMAT,
            line,
            what: format!(
                "{:?} is not a number; {what} is expected",
                word.chars().take(40).collect::<String>()
            ),
        })
    };
    let columns = number("the number of columns")?;
    let rows = number("the number of rows")?;
    let shape = checked_shape(whole(rows), whole(columns))?;
    refuse_short_text(shape, bytes.len())?;
    let mut ends = [0.0; 6];
    for (end, what) in ends.iter_mut().zip([
        "the least x",
        "the greatest x",
        "the least y",
        "the greatest y",
        "the least height",
        "the greatest height",
    ]) {
        *end = number(what)?;
    }
    let mut values = with_capacity(shape)?;
    for index in 0..shape[0] * shape[1] {
        let (row, column) = (index / shape[1] + 1, index % shape[1] + 1);
        values.push(number(&format!(
            "the height of row {row}, column {column}"
        ))?);
    }
    let steps = steps(ends, shape).ok_or_else(|| FileError::BrokenText {
        format: FORMAT,
        line: line_now,
        what: REVERSED.to_owned(),
    })?;
    Ok(finished(values, shape, steps, |height| height >= BLANK))
}

/// The error message for limits in the wrong order.
const REVERSED: &str = "the greatest x and y must lie above the least ones";

/// Distances between columns and rows from the least and greatest x and y.
fn steps(ends: [f64; 6], [rows, columns]: [usize; 2]) -> Option<[f64; 2]> {
    let step = |least: f64, greatest: f64, count: usize| -> Option<f64> {
        let span = greatest - least;
        // A single line of nodes has no spacing.
        if count == 1 {
            return Some(0.0);
        }
        (span.is_finite() && span > 0.0).then(|| span / (count - 1) as f64)
    };
    Some([
        step(ends[0], ends[1], columns)?,
        step(ends[2], ends[3], rows)?,
    ])
}

/// The matrix with missing nodes marked, and the size from its spacing.
fn finished(
    mut values: Vec<f64>,
    [rows, columns]: [usize; 2],
    [dx, dy]: [f64; 2],
    is_missing: impl Fn(f64) -> bool,
) -> Matrix {
    for value in &mut values {
        if is_missing(*value) {
            *value = f64::NAN;
        }
    }
    // Pixels of a single line are taken as square.
    let sides = [
        if columns == 1 { dy } else { dx } * columns as f64,
        if rows == 1 { dx } else { dy } * rows as f64,
    ];
    Matrix {
        size: sides
            .iter()
            .all(|side| side.is_finite() && *side > 0.0)
            .then_some(Size::LikeHeights(sides)),
        ..Matrix::new(values, [rows, columns])
    }
}

fn read_binary(bytes: &[u8]) -> Result<Matrix, FileError> {
    let mut file = Bytes::new(FORMAT, bytes);
    file.take(4, "the magic word")?;
    let columns = file.i16("the number of columns")?;
    let rows = file.i16("the number of rows")?;
    let shape = checked_shape(rows.into(), columns.into())?;
    let start = file.offset();
    let ends = file.doubles("the limits of x, y and z")?;
    let steps = steps(ends, shape).ok_or_else(|| file.broken(start, REVERSED))?;
    let values = file.packed(shape, |element| f64::from(f32::from_le_bytes(element)))?;
    let mut matrix = finished(values, shape, steps, |height| height >= BLANK);
    file.warn_of_rest(&mut matrix.warnings);
    Ok(matrix)
}

/// Contents of the GRID section of a Surfer 7 file.
struct Description {
    shape: [usize; 2],
    steps: [f64; 2],
    blank: f64,
}

/// Sections with a name and a length: the version, the grid's description, its heights.
fn read_binary_7(bytes: &[u8]) -> Result<Matrix, FileError> {
    let mut file = Bytes::new(FORMAT, bytes);
    let mut version = 1;
    let mut grid: Option<Description> = None;
    while file.left() > 0 {
        let start = file.offset();
        let name = file.take(4, "the name of a section")?;
        let length = file.u32("the length of a section")? as usize;
        let end = file.offset().saturating_add(length);
        match name {
            b"DATA" => {
                let Some(Description {
                    shape,
                    steps,
                    blank,
                }) = grid
                else {
                    return Err(
                        file.broken(start, "its DATA section stands before its GRID section")
                    );
                };
                let values = file.packed(shape, f64::from_le_bytes)?;
                return Ok(finished(values, shape, steps, |height| match version {
                    // The first version also marked every larger value as missing.
                    1 => height >= blank,
                    _ => height == blank,
                }));
            }
            BINARY_7 => version = file.i32("the version")?,
            b"GRID" => grid = Some(describe(&mut file)?),
            _ => {}
        }
        file.seek(end, "the next section")?;
    }
    Err(file.broken(file.offset(), "it has no DATA section"))
}

/// Rows, columns, least x and y, steps, least and greatest height, rotation, the missing value.
fn describe(file: &mut Bytes) -> Result<Description, FileError> {
    let rows = file.i32("the number of rows")?;
    let columns = file.i32("the number of columns")?;
    let shape = checked_shape(rows.into(), columns.into())?;
    let start = file.offset();
    let [_, _, dx, dy, _, _, _, blank] = file.doubles("the description of the grid")?;
    if ![dx, dy].iter().all(|step| step.is_finite() && *step > 0.0) {
        return Err(file.broken(
            start,
            format!("its steps of {dx} and {dy} are not positive"),
        ));
    }
    Ok(Description {
        shape,
        steps: [dx, dy],
        blank,
    })
}

/// A number as a count; 0, which no grid has, if it is not a whole number.
fn whole(number: f64) -> i64 {
    if number.fract() == 0.0 && number.abs() < 1e15 {
        number as i64
    } else {
        0
    }
}
