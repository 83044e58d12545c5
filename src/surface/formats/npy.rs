//! Height maps in NumPy's .npy format.
//!
//! Everything that the header claims is compared with the length of the file before memory is
//! allocated.

use std::fs::File;
use std::io::{BufReader, Cursor, Read, Seek, SeekFrom};
use std::ops::Range;

use npyz::{DType, Deserialize, NpyFile, Order, TypeChar};

use crate::surface::MOST_POINTS;
use crate::surface::error::FileError;
use crate::surface::matrix::Matrix;

/// First bytes of a .npy file.
pub(super) const MAGIC: &[u8] = b"\x93NUMPY";

/// Longest header accepted; that of a plain array has 128 bytes.
const LONGEST_HEADER: usize = 4096;

/// Most digits in a shape, so that the product of its numbers fits in 64 bits.
const MOST_SHAPE_DIGITS: usize = 19;

/// Columns and rows of a two-dimensional array, from its header.
pub(super) fn claimed_points(mut file: BufReader<File>) -> Option<[usize; 2]> {
    let header = read_header(&mut file).ok()?;
    let npy = NpyFile::new(Cursor::new(header)).ok()?;
    let &[rows, columns] = npy.shape() else {
        return None;
    };
    Some([columns as usize, rows as usize])
}

/// The same of an array whose rows lie one after another.
pub(super) fn row_major_points(mut file: BufReader<File>) -> Option<[usize; 2]> {
    let header = read_header(&mut file).ok()?;
    let npy = NpyFile::new(Cursor::new(header)).ok()?;
    match (npy.shape(), npy.order()) {
        (&[rows, columns], Order::C) if rows > 0 && columns > 0 => {
            Some([columns as usize, rows as usize])
        }
        _ => None,
    }
}

/// Reads a two-dimensional array of real numbers from `file`, which has `length` bytes.
///
/// # Errors
/// A malformed header, other dimensions or types, and a length that does not fit the shape.
pub(super) fn read(file: impl Read + Seek, length: u64) -> Result<Matrix, FileError> {
    read_part(file, length, None)
}

/// The same of some rows of an array whose rows lie one after another. The matrix has all rows, and the values of these.
///
/// # Errors
/// As [`read`].
pub(super) fn read_rows(
    file: impl Read + Seek,
    length: u64,
    part: Range<usize>,
) -> Result<Matrix, FileError> {
    read_part(file, length, Some(part))
}

fn read_part(
    mut file: impl Read + Seek,
    length: u64,
    part: Option<Range<usize>>,
) -> Result<Matrix, FileError> {
    let header = read_header(&mut file)?;
    let data_length = length.saturating_sub(header.len() as u64);
    let npy = NpyFile::new(Cursor::new(&header)).map_err(|error| broken(error.to_string()))?;

    let &[rows, columns] = npy.shape() else {
        return Err(FileError::Dimensions {
            shape: npy.shape().to_vec(),
        });
    };
    // The header has few enough digits that this cannot overflow.
    let count = rows * columns;
    if count == 0 {
        return Err(FileError::NoNumbers);
    }
    if count > MOST_POINTS as u64 {
        return Err(FileError::TooManyPoints { points: count });
    }
    let (rows, columns) = (rows as usize, columns as usize);
    let element = match npy.dtype() {
        DType::Plain(element) => element,
        other => {
            return Err(FileError::ElementType {
                found: other.descr(),
            });
        }
    };
    let bytes = element.num_bytes().unwrap_or(0) as u64;
    let expected = count.saturating_mul(bytes);
    if data_length < expected {
        return Err(FileError::Truncated {
            rows,
            columns,
            expected,
            found: data_length,
        });
    }
    let mut warnings = Vec::new();
    if data_length > expected {
        warnings.push(format!(
            "the file holds {} bytes after its array, which are not read",
            data_length - expected
        ));
    }

    let order = npy.order();
    let count = match &part {
        None => rows * columns,
        Some(part) => {
            let before = bytes * (part.start * columns) as u64;
            file.seek(SeekFrom::Start(header.len() as u64 + before))
                .map_err(FileError::Read)?;
            part.len() * columns
        }
    };
    let values = match (element.type_char(), element.size_field()) {
        (TypeChar::Float, 2) => numbers::<half::f16>(&header, file, count, f64::from),
        (TypeChar::Float, 4) => numbers::<f32>(&header, file, count, f64::from),
        (TypeChar::Float, 8) => numbers::<f64>(&header, file, count, |value| value),
        (TypeChar::Int, 1) => numbers::<i8>(&header, file, count, f64::from),
        (TypeChar::Int, 2) => numbers::<i16>(&header, file, count, f64::from),
        (TypeChar::Int, 4) => numbers::<i32>(&header, file, count, f64::from),
        (TypeChar::Int, 8) => numbers::<i64>(&header, file, count, |value| value as f64),
        (TypeChar::Uint, 1) => numbers::<u8>(&header, file, count, f64::from),
        (TypeChar::Uint, 2) => numbers::<u16>(&header, file, count, f64::from),
        (TypeChar::Uint, 4) => numbers::<u32>(&header, file, count, f64::from),
        (TypeChar::Uint, 8) => numbers::<u64>(&header, file, count, |value| value as f64),
        _ => {
            return Err(FileError::ElementType {
                found: element.to_string(),
            });
        }
    }?;
    let values = match order {
        Order::C => values,
        // Such an array is read whole.
        Order::Fortran => transposed(&values, rows, columns),
    };
    Ok(Matrix {
        warnings,
        ..Matrix::new(values, [rows, columns])
    })
}

/// The bytes from the magic string to the end of the header, checked so that the parser can neither
/// run out of stack nor overflow.
fn read_header(file: &mut impl Read) -> Result<Vec<u8>, FileError> {
    let mut header = vec![0; 8];
    let mut take = |header: &mut Vec<u8>, from: usize| {
        file.read_exact(&mut header[from..])
            .map_err(|_| broken("it ends within the header".to_owned()))
    };
    take(&mut header, 0)?;
    if !header.starts_with(MAGIC) {
        return Err(broken("it does not begin with \\x93NUMPY".to_owned()));
    }
    let length_bytes = match header[6] {
        1 => 2,
        2 | 3 => 4,
        other => {
            return Err(broken(format!(
                "version {other} of the format is not known"
            )));
        }
    };
    header.resize(8 + length_bytes, 0);
    take(&mut header, 8)?;
    let text_length = header[8..]
        .iter()
        .rev()
        .fold(0_usize, |length, byte| (length << 8) | usize::from(*byte));
    if text_length > LONGEST_HEADER {
        return Err(broken(format!(
            "a header of {text_length} bytes is too long for a plain array"
        )));
    }
    let start = header.len();
    header.resize(start + text_length, 0);
    take(&mut header, start)?;

    let text = &header[start..];
    let plain =
        |byte: &u8| byte.is_ascii_alphanumeric() || b"_'\"{}()[],:<>|=- \t\r\n".contains(byte);
    let brackets = text.iter().filter(|byte| b"([{".contains(byte)).count();
    // Parsing time doubles with each nested bracket, so deeper nesting than any element type has is
    // refused.
    let depths = text.iter().scan(0_usize, |depth, byte| {
        match byte {
            b'(' | b'[' | b'{' => *depth += 1,
            b')' | b']' | b'}' => *depth = depth.saturating_sub(1),
            _ => {}
        }
        Some(*depth)
    });
    let deepest = depths.max().unwrap_or(0);
    if !text.iter().all(plain) || brackets > 16 || deepest > 4 {
        return Err(broken(
            "its header does not describe a plain array".to_owned(),
        ));
    }
    let text = String::from_utf8_lossy(text);
    // Everything after the word, since a key may be given twice.
    let shape = text.split_once("shape").map_or("", |(_, rest)| rest);
    if shape.bytes().filter(u8::is_ascii_digit).count() > MOST_SHAPE_DIGITS {
        let shape = shape.trim_matches(['"', '\'', ':', ' ', ',', '}', '\n']);
        return Err(broken(format!("its shape {shape} exceeds all memory")));
    }
    Ok(header)
}

/// So many elements in the order of the file, from where it stands.
fn numbers<T: Deserialize>(
    header: &[u8],
    file: impl Read,
    count: usize,
    convert: impl Fn(T) -> f64,
) -> Result<Vec<f64>, FileError> {
    let npy =
        NpyFile::new(Cursor::new(header).chain(file)).map_err(|error| broken(error.to_string()))?;
    let elements = npy.data::<T>().map_err(|error| broken(error.to_string()))?;
    let mut values = Vec::new();
    values
        .try_reserve_exact(count)
        .map_err(|_| FileError::TooManyPoints {
            points: count as u64,
        })?;
    for element in elements.take(count) {
        values.push(convert(element.map_err(FileError::Read)?));
    }
    Ok(values)
}

/// Row-major from column-major.
fn transposed(values: &[f64], rows: usize, columns: usize) -> Vec<f64> {
    let mut result = Vec::with_capacity(values.len());
    for row in 0..rows {
        result.extend((0..columns).map(|column| values[column * rows + row]));
    }
    result
}

/// A malformed .npy file.
fn broken(what: String) -> FileError {
    // A parser may add a drawing below its message.
    let sentence = what.lines().next().unwrap_or("");
    let sentence = sentence.split(" --> ").next().unwrap_or("");
    FileError::BrokenNpy {
        what: sentence.trim_end_matches([':', ' ']).to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn file(header: &[u8], elements: &[u8]) -> Vec<u8> {
        let mut bytes = [MAGIC, b"\x01\x00"].concat();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header);
        bytes.extend(elements);
        bytes
    }

    #[test]
    fn version_two_has_a_longer_length() {
        let header = b"{'descr': '<i2', 'fortran_order': True, 'shape': (2, 2)}\n";
        let mut bytes = [MAGIC, b"\x02\x00"].concat();
        bytes.extend((header.len() as u32).to_le_bytes());
        bytes.extend(header);
        bytes.extend([1, 0, 2, 0, 3, 0, 0xFF, 0xFF]);
        let matrix = read(Cursor::new(&bytes), bytes.len() as u64).unwrap();
        assert_eq!((matrix.rows, matrix.columns), (2, 2));
        assert_eq!(matrix.values, [1.0, 3.0, 2.0, -1.0]);
    }

    /// The rows of a part are those of the whole.
    #[test]
    fn rows_are_read_alone() {
        let header = b"{'descr': '<i2', 'fortran_order': False, 'shape': (3, 2)}\n";
        let bytes = file(header, &[1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 0xFF, 0xFF]);
        let length = bytes.len() as u64;
        let all = read(Cursor::new(&bytes), length).unwrap();
        for (part, values) in [(0..3, 0..6), (1..3, 2..6), (2..2, 4..4)] {
            let rows = read_rows(Cursor::new(&bytes), length, part).unwrap();
            assert_eq!((rows.rows, rows.columns), (3, 2));
            assert_eq!(rows.values, all.values[values]);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// Any header gives an error or a matrix; with a few bytes replaced most still reach the
        /// parser.
        #[test]
        fn any_header_gives_an_error_or_a_matrix(
            changes in prop::collection::vec((0_usize..60, prop::sample::select(
                b"0123456789fiucSUVO<>|=bm'\"{}[]():, -TF\xFF\n".to_vec()
            )), 0..4),
            elements in 0_usize..70,
        ) {
            let mut header = b"{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }\n".to_vec();
            for (place, byte) in changes {
                if let Some(old) = header.get_mut(place) {
                    *old = byte;
                }
            }
            let bytes = file(&header, &vec![0; elements]);
            if let Ok(matrix) = read(Cursor::new(&bytes), bytes.len() as u64) {
                prop_assert_eq!(matrix.values.len(), matrix.rows * matrix.columns);
            }
        }
    }
}
