//! Golden Software's Surfer grids (.grd): text (DSAA), 6 binary (DSBB), 7 binary (DSRB).
//!
//! Rows run along x and start at the least y. No unit is stated: coordinates have that of the
//! heights.
//!
//! # Source
//! Golden Software, Surfer user's guide, "ASCII grid file format", "Surfer 6 grid file format" and
//! "Surfer 7 grid file format".

use super::bytes::{Bytes, checked_shape, refuse_short_text};
use super::lines::{Lines, broken_line};
use super::words::{WordRows, Words, checked};
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// First bytes of the three forms.
pub(super) const TEXT: &[u8] = b"DSAA";
pub(super) const BINARY: &[u8] = b"DSBB";
pub(super) const BINARY_7: &[u8] = b"DSRB";

/// Least value that marks a missing node: 1.70141e38, to the digits that every form keeps.
const BLANK: f64 = 1.7014e38;

/// Name of the format in messages.
const FORMAT: &str = ".grd";

/// Reads a grid of any of the three forms.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    match file.beginning(TEXT.len())?.as_slice() {
        TEXT => checked(&file, open_text),
        BINARY => read_binary(file),
        _ => read_binary_7(file),
    }
}

/// Least and greatest x and y, then those of the heights, which are not needed.
fn open_text(file: &Bytes) -> Result<Matrix<WordRows>, FileError> {
    let mut words = Words::new(Lines::latin_1(file));
    words.next()?;
    let columns = number(&mut words, || "the number of columns".to_owned())?;
    let rows = number(&mut words, || "the number of rows".to_owned())?;
    let shape = checked_shape(whole(rows), whole(columns))?;
    refuse_short_text(shape, file.length())?;
    let mut ends = [0.0; 6];
    for (end, what) in ends.iter_mut().zip([
        "the least x",
        "the greatest x",
        "the least y",
        "the greatest y",
        "the least height",
        "the greatest height",
    ]) {
        *end = number(&mut words, || what.to_owned())?;
    }
    let steps = steps(ends, shape).ok_or_else(|| broken_line(FORMAT, words.line(), REVERSED))?;
    let heights = WordRows::new(words, shape, |words, given, [_, columns]| {
        let (row, column) = (given / columns + 1, given % columns + 1);
        let what = || format!("the height of row {row}, column {column}");
        Ok(unless(BLANK, number(words, what)?))
    });
    Ok(map(heights, shape, steps))
}

/// The next number of a text; `what` names it in messages.
fn number(words: &mut Words, what: impl FnOnce() -> String) -> Result<f64, FileError> {
    let Some((line, word)) = words.next()? else {
        return Err(broken_line(
            FORMAT,
            words.line(),
            format!("the file ends before {}", what()),
        ));
    };
    word.parse().map_err(|_| {
        let word: String = word.chars().take(40).collect();
        let what = format!("{word:?} is not a number; {} is expected", what());
        broken_line(FORMAT, line, what)
    })
}

/// A height, which is missing from a value on.
fn unless(blank: f64, height: f64) -> f64 {
    if height >= blank { f64::NAN } else { height }
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

/// The map with the size from its spacing.
fn map<V>(values: V, [rows, columns]: [usize; 2], [dx, dy]: [f64; 2]) -> Matrix<V> {
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

fn read_binary(file: Bytes) -> Result<Map, FileError> {
    let mut file = file.named(FORMAT);
    file.take(4, "the magic word")?;
    let columns = file.i16("the number of columns")?;
    let rows = file.i16("the number of rows")?;
    let shape = checked_shape(rows.into(), columns.into())?;
    let start = file.offset();
    let ends = file.doubles("the limits of x, y and z")?;
    let steps = steps(ends, shape).ok_or_else(|| file.broken(start, REVERSED))?;
    let values = file.packed(shape, |element| {
        unless(BLANK, f32::from_le_bytes(element).into())
    })?;
    let mut matrix = map(values, shape, steps);
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
fn read_binary_7(file: Bytes) -> Result<Map, FileError> {
    let mut file = file.named(FORMAT);
    let mut version = 1;
    let mut grid: Option<Description> = None;
    while file.left() > 0 {
        let start = file.offset();
        let name = file.take(4, "the name of a section")?;
        let length = file.u32("the length of a section")? as usize;
        let end = file.offset().saturating_add(length);
        match name.as_slice() {
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
                let values = file.packed(shape, move |element| {
                    let height = f64::from_le_bytes(element);
                    // The first version also marked every larger value as missing.
                    if version == 1 || height == blank {
                        unless(blank, height)
                    } else {
                        height
                    }
                })?;
                return Ok(map(values, shape, steps));
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
