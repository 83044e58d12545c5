//! Grey TIFF images: 8 or 16 bits a pixel as shades, 32 or 64 bits of floating point as heights.
//!
//! They state no unit, and their resolution is a printer's.

use std::fs::File;
use std::io::BufReader;

use tiff::decoder::{ChunkType, Decoder, DecodingResult, Limits};
use tiff::tags::{ByteOrder, CompressionMethod, PhotometricInterpretation, SampleFormat, Tag};
use tiff::{ColorType, TiffError};

use super::bytes::{Bytes, Opening, Stream, checked_shape};
use super::numbers::{NumberRows, Numbers};
use super::png::{first_line, not_grey, refuse_ratio};
use super::tiff_gdal::{Scaled, WithoutMissing, missing_number, scale_and_offset};
use super::tiff_streams::Streams;
use crate::surface::file_error::FileError;
use crate::surface::matrix::{Map, Matrix};

/// First bytes of a file: both byte orders, and files beyond 4 GiB.
pub(super) const MAGIC: [&[u8]; 4] = [b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"];

/// Room for the decoder's own tables, bytes.
const TABLES: usize = 1 << 20;

/// Numbers of strips or tiles beside each other that are unpacked at once where several processes read the file.
const LARGEST_BAND: usize = 1 << 20;

/// Columns and rows of the first image, from its directory.
pub(super) fn claimed_points(file: BufReader<File>) -> Option<[usize; 2]> {
    let (columns, rows) = Decoder::new(file).ok()?.dimensions().ok()?;
    Some([columns as usize, rows as usize])
}

/// Reads the first image of a file.
pub(super) fn read(file: Bytes) -> Result<Map, FileError> {
    read_held(file, LARGEST_BAND)
}

/// The same, of which at most so many numbers are unpacked at once where several processes read the file.
fn read_held(file: Bytes, most: usize) -> Result<Map, FileError> {
    let mut image = Decoder::new(file.stream()).map_err(broken)?;
    let (columns, rows) = image.dimensions().map_err(broken)?;
    let shape = checked_shape(rows.into(), columns.into())?;
    let bits = match image.colortype().map_err(broken)? {
        ColorType::Gray(bits @ (8 | 16 | 32 | 64)) => bits,
        _ => return Err(not_grey()),
    };
    let size = usize::from(bits / 8);
    refuse_ratio(shape, size, file.length())?;
    let is_float = match image.find_tag_unsigned(Tag::SampleFormat).map_err(broken)? {
        None => false,
        Some(format) => match SampleFormat::from_u16_exhaustive(format) {
            SampleFormat::Uint => false,
            SampleFormat::IEEEFP => true,
            _ => return Err(other_numbers()),
        },
    };
    if is_float != (bits > 16) {
        return Err(other_numbers());
    }
    refuse_unread(&mut image, is_float)?;
    let mut warnings = Vec::new();
    let missing = missing_number(&mut image, bits, &mut warnings)?;
    let line = scale_and_offset(&mut image, bits)?;
    if image.more_images() {
        warnings.push("the file holds several images; the first is read".to_owned());
    }
    let numbers = match first_number(&mut image, shape, size).map_err(broken)? {
        Some(start) => plain(file, start, shape, bits, image.byte_order())?,
        None => {
            let [height, width] = chunk(&mut image, shape).map_err(broken)?;
            // A tile may be larger than the image, but no larger than the file can encode.
            let chunk = checked_shape(height as i64, width as i64)?;
            refuse_ratio(chunk, size, file.length())?;
            // One strip may be the whole map.
            let is_large = chunk[0].saturating_mul(shape[1]) > most;
            let is_streamed = file.opening() == Opening::ByRows && is_large;
            let streams = is_streamed.then(|| {
                Streams::new(&mut image, &file, [shape, chunk], (bits, is_float)).map_err(broken)
            });
            match streams.transpose()?.flatten() {
                Some(streams) => streams.numbers()?,
                None => {
                    let mut limits = Limits::default();
                    limits.decoding_buffer_size = chunk[0] * chunk[1] * size;
                    limits.intermediate_buffer_size = chunk[0] * chunk[1] * size + TABLES;
                    Numbers::Rows(Box::new(ChunkedRows {
                        image: image.with_limits(limits),
                        shape,
                        chunk,
                        band: Vec::new(),
                        given: 0,
                    }))
                }
            }
        }
    };
    let numbers = match missing {
        None => numbers,
        Some(missing) => Numbers::Rows(Box::new(WithoutMissing {
            rows: numbers.into_rows(),
            missing,
        })),
    };
    let numbers = match line {
        None => numbers,
        Some(line) => Numbers::Rows(Box::new(Scaled {
            rows: numbers.into_rows(),
            line,
        })),
    };
    Ok(Matrix {
        grey: !is_float && line.is_none(),
        warnings,
        ..Matrix::new(numbers, shape)
    })
}

pub(super) type Image = Decoder<BufReader<Stream>>;

/// The orientation of an image whose first row is at the top and whose first column is on the left. TIFF does not define 0, which
/// counts as this one.
const UPRIGHT: u16 = 1;

/// The order of bits of which programs differ on whether it holds for pixels of whole bytes.
const LOWEST_BIT_FIRST: u16 = 2;

/// Refuses what would change heights, or their places, and is not read.
fn refuse_unread(image: &mut Image, is_float: bool) -> Result<(), FileError> {
    let orientation: Option<u16> = image.find_tag_unsigned(Tag::Orientation).map_err(broken)?;
    if orientation.is_some_and(|orientation| orientation > UPRIGHT) {
        return Err(FileError::NotSupported {
            what: "TIFF images that are to be turned or mirrored (tag Orientation)",
            instead: "save it upright, with Orientation 1",
        });
    }
    let order: Option<u16> = image.find_tag_unsigned(Tag::FillOrder).map_err(broken)?;
    if order == Some(LOWEST_BIT_FIRST) {
        return Err(FileError::NotSupported {
            what: "TIFF images whose bytes begin with the lowest bit (tag FillOrder)",
            instead: "save it with FillOrder 1",
        });
    }
    let shades = image.find_tag_unsigned(Tag::PhotometricInterpretation);
    if is_float && shades.map_err(broken)? == Some(PhotometricInterpretation::WhiteIsZero.to_u16())
    {
        return Err(FileError::NotSupported {
            what: "TIFF images of heights in which 0 is white",
            instead: "save it with PhotometricInterpretation 1, BlackIsZero",
        });
    }
    Ok(())
}

/// Where the numbers begin, if they lie in the file as they are, row after row; many programs write one strip.
fn first_number(
    image: &mut Image,
    [rows, columns]: [usize; 2],
    size: usize,
) -> Result<Option<usize>, TiffError> {
    let is = |found: Option<u16>, expected: u16| found.is_none_or(|found| found == expected);
    let compression = image.find_tag_unsigned(Tag::Compression)?;
    let shades = image.find_tag_unsigned(Tag::PhotometricInterpretation)?;
    if image.get_chunk_type() != ChunkType::Strip
        || !is(compression, CompressionMethod::None.to_u16())
        || !is(shades, PhotometricInterpretation::BlackIsZero.to_u16())
    {
        return Ok(None);
    }
    let strip = image.find_tag_unsigned::<u64>(Tag::RowsPerStrip)?;
    let strip = strip.unwrap_or(u64::MAX).clamp(1, rows as u64);
    let starts = image.get_tag_u64_vec(Tag::StripOffsets)?;
    let step = strip * (columns * size) as u64;
    let follows = |pair: &[u64]| pair[0].checked_add(step) == Some(pair[1]);
    let is_whole = starts.len() as u64 == (rows as u64).div_ceil(strip);
    let first = starts
        .first()
        .filter(|_| is_whole && starts.windows(2).all(follows));
    Ok(first.and_then(|start| usize::try_from(*start).ok()))
}

/// Numbers that lie in the file as they are.
fn plain(
    mut file: Bytes,
    start: usize,
    shape: [usize; 2],
    bits: u8,
    order: ByteOrder,
) -> Result<Numbers, FileError> {
    let ends = |error: FileError| FileError::BrokenImage {
        format: "TIFF",
        what: first_line(&error.to_string()),
    };
    file.seek(start, "the image").map_err(ends)?;
    let is_little = order == ByteOrder::LittleEndian;
    let shade = |shade: u16| f64::from(shade) / f64::from(u16::MAX);
    let numbers = match (bits, is_little) {
        (8, _) => file.packed(shape, |[shade]| f64::from(shade) / f64::from(u8::MAX)),
        (16, true) => file.packed(shape, move |number| shade(u16::from_le_bytes(number))),
        (16, false) => file.packed(shape, move |number| shade(u16::from_be_bytes(number))),
        (32, true) => file.packed(shape, |number| f32::from_le_bytes(number).into()),
        (32, false) => file.packed(shape, |number| f32::from_be_bytes(number).into()),
        (_, true) => file.packed(shape, f64::from_le_bytes),
        (_, false) => file.packed(shape, f64::from_be_bytes),
    };
    numbers.map_err(ends)
}

/// Rows and columns of a strip or a tile.
fn chunk(image: &mut Image, [rows, columns]: [usize; 2]) -> Result<[usize; 2], TiffError> {
    if image.get_chunk_type() == ChunkType::Strip {
        let strip = image.find_tag_unsigned::<u64>(Tag::RowsPerStrip)?;
        return Ok([
            strip.map_or(rows, |strip| strip.clamp(1, rows as u64) as usize),
            columns,
        ]);
    }
    let side = |side: u32| side.max(1) as usize;
    let width = side(image.get_tag_u32(Tag::TileWidth)?);
    Ok([side(image.get_tag_u32(Tag::TileLength)?), width])
}

/// Rows of strips or tiles, a band of them at a time.
struct ChunkedRows {
    image: Image,
    shape: [usize; 2],
    /// Rows and columns of a strip or tile.
    chunk: [usize; 2],
    /// The band in which the next row lies.
    band: Vec<f64>,
    /// Rows given so far.
    given: usize,
}

impl ChunkedRows {
    /// Reads the band from the next row on.
    fn read_band(&mut self) -> Result<(), FileError> {
        let ([rows, columns], [height, width]) = (self.shape, self.chunk);
        let height_here = height.min(rows - self.given);
        self.band.resize(height_here * columns, 0.0);
        let across = columns.div_ceil(width);
        let first = self.given / height * across;
        for index in 0..across {
            let start = index * width;
            let width = width.min(columns - start);
            let chunk = u32::try_from(first + index).unwrap_or(u32::MAX);
            let values = numbers(self.image.read_chunk(chunk).map_err(broken)?)?;
            if values.len() != height_here * width {
                return Err(not_grey());
            }
            let lines = self.band.chunks_exact_mut(columns);
            for (line, values) in lines.zip(values.chunks_exact(width)) {
                line[start..start + width].copy_from_slice(values);
            }
        }
        Ok(())
    }
}

impl NumberRows for ChunkedRows {
    fn next(&mut self, values: &mut [f64]) -> Result<(), FileError> {
        let columns = self.shape[1];
        for row in values.chunks_exact_mut(columns) {
            let within = self.given % self.chunk[0];
            if within == 0 {
                self.read_band()?;
            }
            row.copy_from_slice(&self.band[within * columns..(within + 1) * columns]);
            self.given += 1;
        }
        Ok(())
    }
}

/// Shades from 0, black, to 1, white, or heights.
fn numbers(pixels: DecodingResult) -> Result<Vec<f64>, FileError> {
    Ok(match pixels {
        DecodingResult::U8(shades) => {
            let shades = shades.into_iter();
            shades
                .map(|shade| f64::from(shade) / f64::from(u8::MAX))
                .collect()
        }
        DecodingResult::U16(shades) => {
            let shades = shades.into_iter();
            shades
                .map(|shade| f64::from(shade) / f64::from(u16::MAX))
                .collect()
        }
        DecodingResult::F32(heights) => heights.into_iter().map(f64::from).collect(),
        DecodingResult::F64(heights) => heights,
        _ => return Err(other_numbers()),
    })
}

/// The error for grey images of other numbers.
fn other_numbers() -> FileError {
    FileError::NotSupported {
        what: "TIFF images of signed whole numbers, of whole ones of 32 bits and of floating-point ones of 16",
        instead: "save the heights as floating-point numbers of 32 bits",
    }
}

/// The error for an image that cannot be read.
pub(super) fn broken(error: impl std::fmt::Display) -> FileError {
    FileError::BrokenImage {
        format: "TIFF",
        what: first_line(&error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::io::Cursor;

    /// Packed in every way: strips and tiles, both orders of bytes, each predictor, 0 as black and as white.
    const PACKED: [&[u8]; 8] = [
        include_bytes!("../../../tests/files/gdal_differences.tif"),
        include_bytes!("../../../tests/files/pillow_lzw.tif"),
        include_bytes!("../../../tests/files/tifffile_deflate.tif"),
        include_bytes!("../../../tests/files/tifffile_packbits.tif"),
        include_bytes!("../../../tests/files/tifffile_planes.tif"),
        include_bytes!("../../../tests/files/tifffile_planes_64.tif"),
        include_bytes!("../../../tests/files/tifffile_strips.tif"),
        include_bytes!("../../../tests/files/tifffile_white_is_zero.tif"),
    ];

    fn whole(bytes: &[u8]) -> Result<Matrix, FileError> {
        let source = Cursor::new(bytes.to_vec());
        read(Bytes::new(source, bytes.len(), Opening::Whole))?.read()
    }

    /// With nothing unpacked at once but a row.
    fn streamed(bytes: &[u8]) -> Result<Matrix, FileError> {
        let source = Cursor::new(bytes.to_vec());
        read_held(Bytes::new(source, bytes.len(), Opening::ByRows), 0)?.read()
    }

    fn same(one: &Matrix, other: &Matrix) -> bool {
        let bits = |matrix: &Matrix| {
            matrix
                .values
                .iter()
                .map(|v| v.to_bits())
                .collect::<Vec<_>>()
        };
        bits(one) == bits(other)
    }

    #[test]
    fn rows_are_unpacked_to_the_same_bits() {
        for (which, bytes) in PACKED.iter().enumerate() {
            let (one, other) = (whole(bytes).unwrap(), streamed(bytes).unwrap());
            assert!(same(&one, &other), "{which}");
        }
    }

    /// One strip of two rows of three numbers, with these tags; not compressed.
    fn image(bits: u16, numbers: &[u8], is_white_zero: bool, tags: &[(u16, &[u8])]) -> Vec<u8> {
        let format = if bits > 16 { 3 } else { 1 };
        let shades = u32::from(!is_white_zero);
        let mut entries: Vec<(u16, u16, u32, u32)> = vec![
            (256, 3, 1, 3),
            (257, 3, 1, 2),
            (258, 3, 1, bits.into()),
            (259, 3, 1, 1),
            (262, 3, 1, shades),
            (273, 4, 1, 8),
            (277, 3, 1, 1),
            (278, 3, 1, 2),
            (279, 4, 1, numbers.len() as u32),
            (339, 3, 1, format),
        ];
        let mut bytes = [b"II*\0\0\0\0\0".as_slice(), numbers].concat();
        for (tag, value) in tags {
            if let [number] = value {
                entries.push((*tag, 3, 1, (*number).into()));
            } else {
                // A text of more than four bytes lies elsewhere.
                entries.push((*tag, 2, value.len() as u32, bytes.len() as u32));
                bytes.extend(*value);
            }
        }
        bytes.resize(bytes.len().next_multiple_of(2), 0);
        entries.sort_unstable();
        let directory = bytes.len() as u32;
        bytes[4..8].copy_from_slice(&directory.to_le_bytes());
        bytes.extend((entries.len() as u16).to_le_bytes());
        for (tag, kind, count, value) in entries {
            bytes.extend(tag.to_le_bytes());
            bytes.extend(u16::to_le_bytes(kind));
            bytes.extend(count.to_le_bytes());
            bytes.extend(value.to_le_bytes());
        }
        bytes.extend([0; 4]);
        bytes
    }

    #[test]
    fn missing_numbers_are_missing_and_what_is_not_read_is_refused() {
        let floats: Vec<u8> = [1.0_f32, -9999.0, 3.5, 4.0, 5.0, -6.0]
            .into_iter()
            .flat_map(f32::to_le_bytes)
            .collect();
        let missing: (u16, &[u8]) = (42113, b"-9999.0\0");
        let found = whole(&image(32, &floats, false, &[missing])).unwrap();
        assert!(found.values[1].is_nan() && found.warnings.is_empty());
        assert_eq!(found.values[2..], [3.5, 4.0, 5.0, -6.0]);
        let found = whole(&image(32, &floats, false, &[(42113, b"none\0")])).unwrap();
        assert_eq!((found.values[1], found.warnings.len()), (-9999.0, 1));
        // Programs end the number with a line end, or state one that the image cannot hold.
        for text in [&b"-9999\n\0"[..], b" -9999 \r\n\0\0", b"\t-9999\0"] {
            let found = whole(&image(32, &floats, false, &[(42113, text)])).unwrap();
            assert!(found.values[1].is_nan() && found.warnings.is_empty());
        }
        for (text, held) in [
            (&b"-1.7976931348623157e308\0"[..], f32::MIN),
            (b"1.7976931348623157e308\0", f32::MAX),
        ] {
            let floats = [1.0, held, 3.5, 4.0, 5.0, -6.0].map(f32::to_le_bytes);
            let bytes = image(32, floats.as_flattened(), false, &[(42113, text)]);
            let found = whole(&bytes).unwrap();
            assert!(found.values[1].is_nan() && found.warnings.is_empty());
            assert_eq!(found.values[2..], [3.5, 4.0, 5.0, -6.0]);
        }
        // A shade is never less than 0.
        let found = whole(&image(
            8,
            &[0, 1, 2, 3, 4, 5],
            false,
            &[(42113, b"-9999\0")],
        ));
        assert_eq!(found.unwrap().values[0], 0.0);
        // Of shades too, also where 0 is white.
        for is_white_zero in [false, true] {
            let missing: (u16, &[u8]) = (42113, b"200\0\0");
            let shades = [0, 51, 200, 102, 255, 1];
            let found = whole(&image(8, &shades, is_white_zero, &[missing])).unwrap();
            assert!(found.values[2].is_nan());
            assert_eq!(found.values[1], if is_white_zero { 0.8 } else { 0.2 });
        }
        let error = whole(&image(32, &floats, true, &[])).unwrap_err();
        assert!(error.to_string().contains("0 is white"), "{error}");
        assert!(whole(&image(32, &floats, false, &[(274, &[1])])).is_ok());
        let error = whole(&image(32, &floats, false, &[(274, &[4])])).unwrap_err();
        assert!(error.to_string().contains("Orientation"), "{error}");
        assert!(whole(&image(32, &floats, false, &[(266, &[1])])).is_ok());
        let error = whole(&image(32, &floats, false, &[(266, &[2])])).unwrap_err();
        assert!(error.to_string().contains("FillOrder"), "{error}");
    }

    /// Scale and offset, as GDAL writes them, were left out. A missing number is one before them.
    #[test]
    fn gdal_scale_and_offset_are_applied() {
        let text =
            b"<GDALMetadata>\n  <Item name=\"OFFSET\" sample=\"0\" role=\"offset\">-10</Item>\n  \
            <Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.5</Item>\n</GDALMetadata>\n\0";
        let missing: (u16, &[u8]) = (42113, b"-9999\0");
        let floats = [1.0_f32, -9999.0, 3.5, 4.0, 5.0, -6.0].map(f32::to_le_bytes);
        let floats = floats.as_flattened();
        let found = whole(&image(32, floats, false, &[missing, (42112, text)])).unwrap();
        assert!(found.values[1].is_nan() && found.values[0] == -9.5);
        assert_eq!(found.values[2..], [-8.25, -8.0, -7.5, -13.0]);
        // Of whole numbers they make heights, also where 0 is white.
        for is_white_zero in [false, true] {
            let shades = [0, 51, 200, 102, 255, 1];
            let found = whole(&image(8, &shades, is_white_zero, &[(42112, text)])).unwrap();
            assert!(!found.grey);
            for (value, shade) in found.values.iter().zip(shades) {
                // Rounding of shades of 1/255 and of 100 units.
                assert!((value - (0.5 * f64::from(shade) - 10.0)).abs() < 1e-12);
            }
        }
        // Other metadata change nothing.
        let text = b"<GDALMetadata><Item name=\"a\">2</Item></GDALMetadata>\0";
        let found = whole(&image(32, floats, false, &[(42112, text)])).unwrap();
        assert_eq!(found.values[0], 1.0);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// Changed and missing bytes give an error or, where the whole can be read, the same.
        #[test]
        fn modified_strips_give_an_error_or_rows(
            which in 0..PACKED.len(),
            changes in prop::collection::vec((0.0..1.0_f64, any::<u8>()), 0..4),
            kept in prop_oneof![3 => Just(1.0), 1 => 0.0..1.0_f64],
        ) {
            let mut bytes = PACKED[which].to_vec();
            for (place, byte) in changes {
                let place = (place * bytes.len() as f64) as usize;
                bytes[place] = byte;
            }
            bytes.truncate((kept * bytes.len() as f64) as usize);
            if let (Ok(one), Ok(other)) = (whole(&bytes), streamed(&bytes)) {
                prop_assert!(same(&one, &other));
            }
        }
    }
}
