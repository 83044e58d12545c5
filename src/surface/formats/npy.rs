//! Height maps in NumPy's .npy format.
//!
//! Everything that the header claims is compared with the length of the file before memory is
//! allocated.

use std::convert::identity;
use std::fs::File;
use std::io::{BufReader, Cursor, Read};

use half::f16;
use npyz::{DType, NpyFile, Order, TypeChar};

use super::bytes::Bytes;
use crate::surface::MOST_POINTS;
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix};

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

/// Reads a two-dimensional array of real numbers.
///
/// # Errors
/// A malformed header, other dimensions or types, and a length that does not fit the shape.
pub(super) fn read(mut file: Bytes) -> Result<Map, FileError> {
    let header = read_header(&mut file.stream())?;
    file.skip(header.len(), "the header")?;
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
    let shape = [rows as usize, columns as usize];
    let element = match npy.dtype() {
        DType::Plain(element) => element,
        other => {
            return Err(FileError::ElementType {
                found: other.descr(),
            });
        }
    };
    let (order, is_big) = (npy.order(), element.to_string().starts_with('>'));
    macro_rules! numbers {
        ($Number:ident, $convert:path) => {
            match (order, is_big) {
                (Order::C, false) => {
                    file.packed(shape, |bytes| $convert($Number::from_le_bytes(bytes)))
                }
                (Order::C, true) => {
                    file.packed(shape, |bytes| $convert($Number::from_be_bytes(bytes)))
                }
                (Order::Fortran, false) => {
                    file.by_columns(shape, |bytes| $convert($Number::from_le_bytes(bytes)))
                }
                (Order::Fortran, true) => {
                    file.by_columns(shape, |bytes| $convert($Number::from_be_bytes(bytes)))
                }
            }
        };
    }
    let values = match (element.type_char(), element.size_field()) {
        (TypeChar::Float, 2) => numbers!(f16, f64::from),
        (TypeChar::Float, 4) => numbers!(f32, f64::from),
        (TypeChar::Float, 8) => numbers!(f64, identity),
        (TypeChar::Int, 1) => numbers!(i8, f64::from),
        (TypeChar::Int, 2) => numbers!(i16, f64::from),
        (TypeChar::Int, 4) => numbers!(i32, f64::from),
        (TypeChar::Int, 8) => numbers!(i64, nearest),
        (TypeChar::Uint, 1) => numbers!(u8, f64::from),
        (TypeChar::Uint, 2) => numbers!(u16, f64::from),
        (TypeChar::Uint, 4) => numbers!(u32, f64::from),
        (TypeChar::Uint, 8) => numbers!(u64, nearest),
        _ => {
            return Err(FileError::ElementType {
                found: element.to_string(),
            });
        }
    }?;
    let mut warnings = Vec::new();
    if file.left() > 0 {
        warnings.push(format!(
            "the file holds {} bytes after its array, which are not read",
            file.left()
        ));
    }
    Ok(Matrix {
        warnings,
        ..Matrix::new(values, shape)
    })
}

/// The double that is nearest to a whole number, which may have more digits.
fn nearest(number: impl Into<i128>) -> f64 {
    number.into() as f64
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

    // Python 2 writes long integers with their mark: (3L, 4L).
    for at in start + 1..header.len() {
        if header[at] == b'L' && header[at - 1].is_ascii_digit() {
            header[at] = b' ';
        }
    }
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
        let matrix = read(Bytes::held(bytes)).and_then(Map::read).unwrap();
        assert_eq!((matrix.rows, matrix.columns), (2, 2));
        assert_eq!(matrix.values, [1.0, 3.0, 2.0, -1.0]);
    }

    /// Python 2 marks long integers.
    #[test]
    fn shapes_of_python_2_are_read() {
        let header = b"{'descr': '<i2', 'fortran_order': False, 'shape': (2L, 3L)}\n";
        let elements = [1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0];
        let bytes = file(header, &elements);
        let matrix = read(Bytes::held(bytes)).and_then(Map::read).unwrap();
        assert_eq!((matrix.rows, matrix.columns), (2, 3));
        assert_eq!(matrix.values, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }

    /// Rows that are read alone are those of the whole, in every order of rows and bytes.
    #[test]
    fn rows_are_read_alone() {
        let numbers = [1.0_f64, 2.5, -3.0, 4.0, 5.0, 6.0];
        for (order, is_big) in [
            ("False", false),
            ("False", true),
            ("True", false),
            ("True", true),
        ] {
            let kind = if is_big { ">f8" } else { "<f8" };
            let header =
                format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': (3, 2)}}\n");
            let elements = numbers.map(|number| match is_big {
                true => number.to_be_bytes(),
                false => number.to_le_bytes(),
            });
            let open = || read(Bytes::held(file(header.as_bytes(), &elements.concat()))).unwrap();
            let expected = match order {
                "True" => [1.0, 4.0, 2.5, 5.0, -3.0, 6.0],
                _ => numbers,
            };
            assert_eq!(open().read().unwrap().values, expected, "{header}");
            let mut rows = open().values.into_rows();
            for expected in [&expected[..4], &expected[4..]] {
                let mut found = vec![0.0; expected.len()];
                rows.next(&mut found).unwrap();
                assert_eq!(found, expected, "{header}");
            }
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
            if let Ok(matrix) = read(Bytes::held(bytes)).and_then(Map::read) {
                prop_assert_eq!(matrix.values.len(), matrix.rows * matrix.columns);
            }
        }
    }
}
