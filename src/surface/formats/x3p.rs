//! X3P (ISO 25178-72): a ZIP archive of a description in XML and of the heights in metres, x fastest.
//!
//! # Source
//! ISO 25178-72:2017; OpenGPS, "X3P", <https://sourceforge.net/p/open-gps/mwiki/X3p/>.

use std::fs::File;
use std::io::{BufReader, Read, Seek};

use roxmltree::{Document, Node};
use zip::ZipArchive;

use super::bytes::{Bytes, checked_shape};
use super::numbers::{Decode, NumberRows, Numbers, decoded};
use super::zip_entry::ZipEntry;
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix, Size};

/// First bytes of a file.
pub(super) const MAGIC: &[u8] = b"PK\x03\x04";

/// Name of the format in messages.
const FORMAT: &str = ".x3p";

/// The description within the archive, and the longest one read.
const DESCRIPTION: &str = "main.xml";
const LONGEST_DESCRIPTION: u64 = 1 << 24;

/// What the description says.
struct Description {
    shape: [usize; 2],
    /// Pixel lengths along x and y, m.
    pixel: [f64; 2],
    /// Metres per unit of the numbers.
    unit: f64,
    number: Number,
    /// Name of the file of the numbers.
    numbers: String,
    /// Name of the file that says which points are valid, if there is one.
    valid: Option<String>,
}

/// How numbers are stored.
#[derive(Clone, Copy)]
enum Number {
    Int16,
    Int32,
    Single,
    Double,
}

/// Reads the heights.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    let mut archive = open(file.stream())?;
    let description = describe(&mut archive)?;
    let shape = description.shape;
    let [rows, columns] = shape;
    let [dx, dy] = description.pixel;
    let numbers = ZipEntry::open(&file, &mut archive, &description.numbers).map_err(broken)?;
    let stream = |size, decode| StreamedRows {
        numbers,
        shape,
        size,
        decode,
        bytes: Vec::new(),
        given: 0,
    };
    let rows_of_numbers = match description.number {
        Number::Int16 => stream(2, decoded(|number| i16::from_le_bytes(number).into())),
        Number::Int32 => stream(4, decoded(|number| i32::from_le_bytes(number).into())),
        Number::Single => stream(4, decoded(|number| f32::from_le_bytes(number).into())),
        Number::Double => stream(8, decoded(f64::from_le_bytes)),
    };
    let mut numbers = Numbers::Rows(Box::new(rows_of_numbers));
    if let Some(valid) = &description.valid {
        let bits = ZipEntry::open(&file, &mut archive, valid).map_err(broken)?;
        let expected = (rows * columns).div_ceil(u8::BITS as usize);
        if bits.length() != expected as u64 {
            return Err(broken(format!(
                "{valid} has {} bytes; a bit for each of {rows} x {columns} points takes {expected}",
                bits.length()
            )));
        }
        let invalid = InvalidPoints {
            bits,
            byte: [0],
            given: 0,
        };
        numbers = numbers.covered(Numbers::Rows(Box::new(invalid)), columns);
    }
    Ok(Matrix {
        size: Some(Size::Metres([dx * columns as f64, dy * rows as f64])),
        unit: Some(description.unit),
        ..Matrix::new(numbers, shape)
    })
}

/// Rows as they are unpacked.
struct StreamedRows {
    numbers: ZipEntry,
    shape: [usize; 2],
    /// Bytes of a number.
    size: usize,
    decode: Decode,
    /// Those of a row.
    bytes: Vec<u8>,
    /// Rows given so far.
    given: usize,
}

impl NumberRows for StreamedRows {
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        let [rows, columns] = self.shape;
        let length = columns * self.size;
        for row in values.chunks_exact_mut(columns) {
            self.bytes.clear();
            let mut next = self.numbers.by_ref().take(length as u64);
            next.read_to_end(&mut self.bytes).map_err(broken)?;
            if self.bytes.len() < length {
                return Err(FileError::Truncated {
                    rows,
                    columns,
                    expected: (rows * length) as u64,
                    found: (self.given * length + self.bytes.len()) as u64,
                });
            }
            (self.decode)(&self.bytes, row);
            self.given += 1;
        }
        Ok(())
    }
}

/// 1 for each point that is marked as invalid, else 0. A set bit is a valid point, the first of a byte its lowest bit, and rows
/// follow each other within a byte.
struct InvalidPoints {
    bits: ZipEntry,
    /// The byte of the last point.
    byte: [u8; 1],
    /// Points given so far.
    given: usize,
}

impl NumberRows for InvalidPoints {
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        for value in values {
            let place = self.given % u8::BITS as usize;
            if place == 0 {
                self.bits.read_exact(&mut self.byte).map_err(broken)?;
            }
            *value = f64::from(1 - (self.byte[0] >> place & 1));
            self.given += 1;
        }
        Ok(())
    }
}

/// Points along x and y, from the description alone.
pub(super) fn claimed_points(file: BufReader<File>) -> Option<[usize; 2]> {
    let [rows, columns] = describe(&mut open(file).ok()?).ok()?.shape;
    Some([columns, rows])
}

fn open<R: Read + Seek>(file: R) -> Result<ZipArchive<R>, FileError> {
    ZipArchive::new(file).map_err(broken)
}

/// An archive that cannot be read.
fn broken(problem: impl std::fmt::Display) -> FileError {
    FileError::Broken {
        format: FORMAT,
        offset: 0,
        what: format!("its archive is not whole ({problem})"),
    }
}

/// Reads the description.
fn describe<R: Read + Seek>(archive: &mut ZipArchive<R>) -> Result<Description, FileError> {
    let wrong = |what: String| FileError::Broken {
        format: FORMAT,
        offset: 0,
        what: format!("{DESCRIPTION}: {what}"),
    };
    if archive
        .file_names()
        .any(|name| name.is_ok_and(|name| name.ends_with(".npy")))
    {
        return Err(FileError::NotSupported {
            what: "NumPy's archives (.npz)",
            instead: "save one array as .npy by numpy.save",
        });
    }
    let Ok(entry) = archive.by_name(DESCRIPTION) else {
        return Err(wrong("is not in the archive, which is no .x3p".to_owned()));
    };
    let mut text = Vec::new();
    entry
        .take(LONGEST_DESCRIPTION)
        .read_to_end(&mut text)
        .map_err(broken)?;
    let text = String::from_utf8_lossy(&text);
    let document = Document::parse(&text).map_err(|error| wrong(error.to_string()))?;
    let find = |path: &[&str]| -> Option<&str> {
        let mut node: Node = document.root_element();
        for name in path {
            node = node
                .children()
                .find(|child| child.tag_name().name() == *name)?;
        }
        node.text().map(str::trim)
    };
    let read =
        |path: &[&str]| find(path).ok_or_else(|| wrong(format!("{} is missing", path.join("/"))));
    let count = |name: &str| {
        let path = ["Record3", "MatrixDimension", name];
        let text = read(&path)?;
        let count = text.parse::<i64>();
        count.map_err(|_| wrong(format!("{name} = {text:?} is not a count")))
    };
    let length = |axis: &str| {
        let path = ["Record1", "Axes", axis, "Increment"];
        let length = read(&path)?.parse().ok();
        let length = length.filter(|length: &f64| length.is_finite() && *length > 0.0);
        length.ok_or_else(|| wrong(format!("{} is not a length", path.join("/"))))
    };
    // Of an absolute axis the coordinates stand beside the heights.
    let is_absolute = |axis: &&str| find(&["Record1", "Axes", axis, "AxisType"]) == Some("A");
    if find(&["Record1", "FeatureType"]).is_some_and(|kind| kind != "SUR")
        || count("SizeZ")? != 1
        || ["CX", "CY"].iter().any(is_absolute)
    {
        return Err(FileError::NotSupported {
            what: ".x3p files of profiles, point clouds, coordinates or several layers",
            instead: "save one surface on a grid",
        });
    }
    let data = read(&["Record1", "Axes", "CZ", "DataType"])?;
    Ok(Description {
        shape: checked_shape(count("SizeY")?, count("SizeX")?)?,
        pixel: [length("CX")?, length("CY")?],
        unit: match find(&["Record1", "Axes", "CZ", "Increment"]) {
            None => 1.0,
            Some(_) => length("CZ")?,
        },
        number: match data {
            "I" => Number::Int16,
            "L" => Number::Int32,
            "F" => Number::Single,
            "D" => Number::Double,
            other => return Err(wrong(format!("numbers of the unknown type {other:?}"))),
        },
        numbers: read(&["Record3", "DataLink", "PointDataLink"])?.to_owned(),
        valid: find(&["Record3", "DataLink", "ValidPointsLink"])
            .filter(|name| !name.is_empty())
            .map(str::to_owned),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Cursor, Write};
    use zip::write::SimpleFileOptions;

    use crate::surface::formats::Opening;

    /// Two rows of five points as whole numbers of 0.1 nm, with this type of the axis x and these bits of valid points.
    fn file(axis: &str, valid: &[u8]) -> Vec<u8> {
        let description = "<p:ISO5436_2 xmlns:p=\"http://www.opengps.eu/2008/ISO5436_2\"><Record1><FeatureType>SUR</FeatureType>\
             <Axes><CX><AxisType>AXIS</AxisType><Increment>1e-6</Increment></CX><CY><Increment>2e-6</Increment></CY>\
             <CZ><DataType>L</DataType><Increment>1e-10</Increment></CZ></Axes></Record1><Record3>\
             <MatrixDimension><SizeX>5</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ></MatrixDimension>\
             <DataLink><PointDataLink>bindata/data.bin</PointDataLink>\
             <ValidPointsLink>bindata/valid.bin</ValidPointsLink></DataLink></Record3></p:ISO5436_2>"
            .replace("AXIS", axis);
        let numbers: Vec<u8> = (1_i32..11).flat_map(i32::to_le_bytes).collect();
        let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (name, bytes) in [
            (DESCRIPTION, description.as_bytes()),
            ("bindata/data.bin", &numbers),
            ("bindata/valid.bin", valid),
        ] {
            // `Stored` needs no feature of the archive's crate.
            let options =
                SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
            archive.start_file(name, options).unwrap();
            archive.write_all(bytes).unwrap();
        }
        archive.finish().unwrap().into_inner()
    }

    fn opened(bytes: &[u8], opening: Opening) -> Result<Matrix, FileError> {
        let source = Cursor::new(bytes.to_vec());
        read(Bytes::new(source, bytes.len(), opening))?.read()
    }

    #[test]
    fn coordinates_beside_heights_are_refused() {
        let error = opened(&file("A", &[0xff; 2]), Opening::Whole).unwrap_err();
        assert!(error.to_string().contains("coordinates"), "{error}");
    }

    #[test]
    fn points_marked_as_invalid_are_missing() {
        // The third point of the first row, and the fifth of the second, which is the second bit of the second byte.
        let bytes = file("I", &[0b1111_1011, 0b1111_1101]);
        for opening in [Opening::Whole, Opening::ByRows] {
            let found = opened(&bytes, opening).unwrap();
            for (at, value) in found.values.iter().enumerate() {
                match at {
                    2 | 9 => assert!(value.is_nan(), "{at}: {value}"),
                    _ => assert_eq!(*value, (at + 1) as f64),
                }
            }
        }
        let error = opened(&file("I", &[255; 10]), Opening::Whole).unwrap_err();
        assert!(
            error
                .to_string()
                .contains("bindata/valid.bin has 10 bytes; a bit for each of 2 x 5 points takes 2"),
            "{error}"
        );
    }
}
