//! Surface data files (.sdf), the exchange format of profilers: text and binary.
//!
//! Lengths are in metres. The formats before the standard (BCR, NPL) differ only in their magic
//! words; version 2 has wider counts.
//!
//! # Source
//! ISO 25178-71:2017, clause 5; its forerunner in Stout et al. 1993, report EUR 15178 EN.

use super::bytes::{Bytes, checked_shape, refuse_short_text};
use super::lines::{Lines, broken_line};
use super::words::{WordRows, Words, checked};
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// First bytes of a file: `a` for text or `b` for binary, then the organisation that defined the
/// version.
pub(super) const MAGIC: [&[u8]; 5] = [b"aISO-", b"aBCR-", b"aNPL-", b"bISO-", b"bBCR-"];

/// Name of the format in messages.
const FORMAT: &str = ".sdf";

/// The word for a missing point in text.
const MISSING: &str = "BAD";

/// Reads a surface of either form.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    if file.beginning(1)? == b"b" {
        read_binary(file)
    } else {
        checked(&file, open_text)
    }
}

/// The required entries of both headers.
struct Header {
    columns: i64,
    rows: i64,
    scales: [f64; 3],
    compression: i64,
    data_type: i64,
}

impl Header {
    /// Rows and columns, if the header is supported.
    fn shape(&self) -> Result<[usize; 2], FileError> {
        if self.compression != 0 {
            return Err(FileError::NotSupported {
                what: "compressed .sdf files",
                instead: "save it without compression",
            });
        }
        checked_shape(self.rows, self.columns)
    }

    /// An error message if the scales are wrong.
    fn scale_error(&self) -> Option<String> {
        let [x, y, z] = self.scales;
        // A single profile has no scale along y.
        let y_stands = (y.is_finite() && y > 0.0) || self.rows == 1;
        let stands = x.is_finite() && x > 0.0 && y_stands && z.is_finite() && z != 0.0;
        (!stands).then(|| format!("Xscale = {x}, Yscale = {y}, Zscale = {z} are not lengths"))
    }

    fn matrix<V>(&self, values: V, [rows, columns]: [usize; 2]) -> Matrix<V> {
        let [x, y, z] = self.scales;
        let y = if rows == 1 { x } else { y };
        Matrix {
            size: Some(Size::Metres([x * columns as f64, y * rows as f64])),
            unit: Some(z),
            ..Matrix::new(values, [rows, columns])
        }
    }
}

fn read_binary(file: Bytes) -> Result<Map, FileError> {
    let mut file = file.named(FORMAT);
    let magic = file.take(8, "the magic word")?;
    file.take(10 + 12 + 12, "the maker and the dates")?;
    let (columns, rows) = if magic.ends_with(b"2.0") {
        (
            file.u32("the number of points")?.into(),
            file.u32("the number of profiles")?.into(),
        )
    } else {
        (
            file.u16("the number of points")?.into(),
            file.u16("the number of profiles")?.into(),
        )
    };
    let place = file.offset();
    let [x, y, z, _] = file.doubles("the scales")?;
    let header = Header {
        columns,
        rows,
        scales: [x, y, z],
        compression: file.u8("the compression")?.into(),
        data_type: file.u8("the type of the data")?.into(),
    };
    if let Some(scale_error) = header.scale_error() {
        return Err(file.broken(place, scale_error));
    }
    file.take(1, "the checksum's type")?;
    let shape = header.shape()?;
    /// Numbers of a type, of which one marks missing points.
    macro_rules! marked {
        ($Number:ident::$MISSING:ident) => {
            file.packed(shape, |element| match $Number::from_le_bytes(element) {
                $Number::$MISSING => f64::NAN,
                value => value.into(),
            })
        };
    }
    let values = match header.data_type {
        0 => file.packed(shape, |[byte]| f64::from(byte)),
        1 => marked!(u16::MAX),
        2 => marked!(u32::MAX),
        3 => marked!(f32::MIN),
        4 => marked!(i8::MIN),
        5 => marked!(i16::MIN),
        6 => marked!(i32::MIN),
        7 => marked!(f64::MIN),
        other => {
            return Err(file.broken(place + 33, format!("type {other} of data is not known")));
        }
    }?;
    Ok(header.matrix(values, shape))
}

fn open_text(file: &Bytes) -> Result<Matrix<WordRows>, FileError> {
    let mut lines = Lines::latin_1(file);
    // Of entries with one name the first counts; the maker and the dates are not numbers and not needed.
    let mut found = [None; NUMBERS.len()];
    let mut end = None;
    lines.advance()?;
    while lines.advance()? {
        let line = lines.line();
        if line.trim_start().starts_with('*') {
            end = Some(lines.number());
            break;
        }
        let Some((name, value)) = line.split_once('=') else {
            continue;
        };
        let name = name.trim().to_ascii_lowercase();
        let known = |known: &&str| known.eq_ignore_ascii_case(&name);
        let Some(place) = NUMBERS.iter().position(known) else {
            continue;
        };
        let number = value.trim().parse().map_err(|_| {
            let value: String = value.trim().chars().take(40).collect();
            let what = format!("{name} = {value:?} is not a number");
            broken_line(FORMAT, lines.number(), what)
        })?;
        found[place].get_or_insert(number);
    }
    let Some(end) = end else {
        let what = "no line with an asterisk ends the header";
        return Err(broken_line(FORMAT, 1, what));
    };
    let entry = |name: &str| -> Option<f64> {
        let place = NUMBERS.iter().position(|known| *known == name);
        found[place?]
    };
    let number = |name: &str| -> Result<f64, FileError> {
        let absent = || broken_line(FORMAT, end, format!("its header has no {name}"));
        entry(name).ok_or_else(absent)
    };
    let header = Header {
        columns: number("NumPoints")? as i64,
        rows: number("NumProfiles")? as i64,
        scales: [number("Xscale")?, number("Yscale")?, number("Zscale")?],
        compression: entry("Compression").unwrap_or(0.0) as i64,
        data_type: entry("DataType").unwrap_or(7.0) as i64,
    };
    if let Some(scale_error) = header.scale_error() {
        return Err(broken_line(FORMAT, end, scale_error));
    }
    let shape = header.shape()?;
    refuse_short_text(shape, file.length())?;
    let heights = WordRows::new(Words::new(lines), shape, height);
    Ok(header.matrix(heights, shape))
}

/// The next height of a text of such a shape, of which so many are read.
fn height(words: &mut Words, given: usize, [rows, columns]: [usize; 2]) -> Result<f64, FileError> {
    let (line, word) = match words.next()? {
        Some((line, word)) if !word.starts_with('*') => (line, word),
        _ => {
            let (points, row) = (rows * columns, given / columns + 1);
            let what = format!("the heights end after {given} of {points}, in row {row}");
            return Err(broken_line(FORMAT, words.last_line(), what));
        }
    };
    if word.eq_ignore_ascii_case(MISSING) {
        return Ok(f64::NAN);
    }
    word.parse().map_err(|_| FileError::NotANumber {
        line,
        row: given / columns + 1,
        column: given % columns + 1,
        text: word.chars().take(40).collect(),
    })
}

/// Entries of a text header that are numbers.
const NUMBERS: [&str; 7] = [
    "NumPoints",
    "NumProfiles",
    "Xscale",
    "Yscale",
    "Zscale",
    "Compression",
    "DataType",
];
