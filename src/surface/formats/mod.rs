//! Formats of height files: one table, selected by the first bytes and then by the extension.
//!
//! A format reads what a file says of its map, and gives the numbers row after row; the whole map is all of its rows. The shape
//! that a file claims is compared with the file's length before memory is allocated.

mod al3d;
mod bytes;
mod fields;
mod frame;
mod gsf;
mod gwy;
mod ibw;
pub(crate) mod instrument_header;
mod length;
mod lines;
mod metropro;
mod nanoscope;
mod nid;
mod npy;
mod numbers;
mod opd;
mod plu;
#[cfg(feature = "images")]
mod png;
mod remarks;
mod sdf;
mod sur;
mod surfer;
mod text;
#[cfg(feature = "images")]
mod tiff;
#[cfg(feature = "images")]
mod tiff_gdal;
#[cfg(feature = "images")]
mod tiff_streams;
mod unordered;
mod vk4;
#[cfg(not(feature = "images"))]
mod without_images;
mod words;
#[cfg(feature = "images")]
mod x3p;
mod xyz;
#[cfg(feature = "images")]
mod zip_entry;

use std::fs::{self, File};
use std::io::{BufRead, BufReader, ErrorKind};
use std::path::Path;

use super::file_error::FileError;
use super::matrix::{Map, Matrix};
use bytes::Bytes;
pub(super) use bytes::Opening;
pub(super) use numbers::Numbers;
#[cfg(not(feature = "images"))]
use without_images::{png, tiff, x3p};
pub(super) use xyz::UNEVEN;

/// Longest file of most formats, 16 GiB: the largest grid in doubles, twice.
const LONGEST: u64 = 1 << 34;

/// Longest text file read, 4 GiB: its numbers need up to four times that memory.
const LONGEST_TEXT: u64 = 1 << 32;

/// A format of height files.
struct Format {
    /// Its name in messages, without article.
    name: &'static str,
    /// Extensions, lower case.
    extensions: &'static [&'static str],
    /// Possible first bytes; empty for text, which may begin with anything.
    magic: &'static [&'static [u8]],
    /// Longest file read.
    longest: u64,
    /// Opens the map.
    read: Reader,
}

/// Reads what a file says of its map, and where its numbers are.
type Reader = fn(Bytes) -> Result<Map, FileError>;

impl Format {
    /// A format of files of common length; text, which may begin with anything, has no first bytes.
    const fn new(
        name: &'static str,
        extensions: &'static [&'static str],
        magic: &'static [&'static [u8]],
        read: Reader,
    ) -> Self {
        Format {
            name,
            extensions,
            magic,
            longest: if magic.is_empty() {
                LONGEST_TEXT
            } else {
                LONGEST
            },
            read,
        }
    }
}

/// All supported formats.
static FORMATS: &[Format] = &[
    Format {
        name: "NumPy array (.npy)",
        extensions: &["npy"],
        magic: &[npy::MAGIC],
        longest: u64::MAX,
        read: npy::read,
    },
    Format::new("PNG image", &["png"], &[png::MAGIC], png::read),
    Format::new("TIFF image", &["tif", "tiff"], &tiff::MAGIC, tiff::read),
    Format::new(
        "Gwyddion simple field (.gsf)",
        &["gsf"],
        &[gsf::MAGIC],
        gsf::read,
    ),
    Format::new("Gwyddion file (.gwy)", &["gwy"], &[gwy::MAGIC], gwy::read),
    Format::new(
        "Surfer grid (.grd)",
        &["grd"],
        &[surfer::TEXT, surfer::BINARY, surfer::BINARY_7],
        surfer::read,
    ),
    Format::new("surface data file (.sdf)", &["sdf"], &sdf::MAGIC, sdf::read),
    Format::new(
        "Digital Surf surface (.sur)",
        &["sur"],
        &[sur::MAGIC, sur::COMPRESSED],
        sur::read,
    ),
    Format::new(
        "Alicona height map (.al3d)",
        &["al3d"],
        &[al3d::MAGIC],
        al3d::read,
    ),
    Format::new(
        "Nanoscope image (.spm, .001)",
        &["spm", "000", "001", "002", "003", "004", "005", "di"],
        &[nanoscope::MAGIC],
        nanoscope::read,
    ),
    Format::new(
        "binary wave of Igor (.ibw)",
        &["ibw"],
        &[ibw::MAGIC],
        ibw::read,
    ),
    Format::new("Nanosurf image (.nid)", &["nid"], &[nid::MAGIC], nid::read),
    Format::new(
        "Keyence map (.vk4, .vk6)",
        &["vk3", "vk4", "vk6", "vk7"],
        &vk4::MAGIC,
        vk4::read,
    ),
    Format::new(
        "MetroPro map (.dat)",
        &["dat"],
        &metropro::MAGIC,
        metropro::read,
    ),
    Format::new("Wyko map (.opd)", &["opd"], &[opd::MAGIC], opd::read),
    Format::new("ZIP archive (.x3p)", &["x3p"], &[x3p::MAGIC], x3p::read),
    Format {
        longest: LONGEST,
        ..Format::new("Sensofar topography (.plu)", &["plu"], &[], plu::read)
    },
    Format::new("columns x y z (.xyz)", &["xyz"], &[], xyz::read),
    Format::new(
        "text",
        &["txt", "csv", "tsv", "dat", "asc"],
        &[],
        text::read,
    ),
];

/// Reads only the numbers of columns and rows from a header.
type Claim = fn(BufReader<File>) -> Option<[usize; 2]>;

/// Formats whose length does not tell how much memory their numbers take: compressed ones, and
/// those that may store one byte a number.
const CLAIMS: [(&[&[u8]], Claim); 5] = [
    (&[npy::MAGIC], npy::claimed_points),
    (&[x3p::MAGIC], x3p::claimed_points),
    (&[png::MAGIC], png::claimed_points),
    (&tiff::MAGIC, tiff::claimed_points),
    (&vk4::MAGIC, vk4::claimed_points),
];

/// Points along x and y that the header of an image or an array claims.
///
/// `None` for other formats, which hold no more numbers than bytes, and for a file that cannot be
/// read: reading it reports the reason.
pub fn claimed_points(path: &Path) -> Option<[usize; 2]> {
    if !fs::metadata(path).ok()?.is_file() {
        return None;
    }
    let mut file = BufReader::new(File::open(path).ok()?);
    let start = file.fill_buf().ok()?;
    let begins = |magic: &&[u8]| start.starts_with(magic);
    let (_, claim) = CLAIMS.iter().find(|(magic, _)| magic.iter().any(begins))?;
    claim(file)
}

/// First bytes of unsupported files that may carry a supported extension, with their names.
const UNSUPPORTED: [(&[u8], &str); 3] = [
    (b"\x89HDF", "HDF5 file"),
    (b"\xFF\xD8\xFF", "JPEG image"),
    (b"\x1F\x8B", "gzip-compressed file"),
];

/// A file, its format and its length.
fn open(path: &Path) -> Result<(BufReader<File>, &'static Format, u64), FileError> {
    // Check the kind of path before its extension: a folder is not an unknown kind of file.
    let metadata = fs::metadata(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => FileError::NotFound,
        _ => FileError::Read(error),
    })?;
    if metadata.is_dir() {
        return Err(FileError::Folder);
    }
    if !metadata.is_file() {
        // Opening a pipe would wait for its writer.
        return Err(FileError::NotRegular);
    }
    let length = metadata.len();
    let mut file = BufReader::new(File::open(path).map_err(FileError::Read)?);
    let start = file.fill_buf().map_err(FileError::Read)?;
    let extension = path
        .extension()
        .map(|extension| extension.to_string_lossy().to_ascii_lowercase());
    let format = find(start, extension.as_deref())?;
    Ok((file, format, length))
}

/// What a file says of its map, whose numbers are still to be read.
///
/// # Errors
/// See [`FileError`].
pub(super) fn open_map(path: &Path, opening: Opening) -> Result<Map, FileError> {
    let (file, format, length) = open(path)?;
    if length == 0 {
        return Err(FileError::Empty);
    }
    if length > format.longest {
        return Err(FileError::TooLong { bytes: length });
    }
    // If the file grows while it is read, the extra bytes are ignored.
    let length = usize::try_from(length).map_err(|_| FileError::TooLong { bytes: length })?;
    (format.read)(Bytes::new(file, length, opening))
}

/// What a file says of its map at a glance; of a text that is longer than its beginning about so many rows.
///
/// # Errors
/// As [`open_map`].
pub(super) fn glance(path: &Path) -> Result<Matrix<()>, FileError> {
    Ok(open_map(path, Opening::Glance)?.split().1)
}

/// The format of a file that begins with `start`; its extension must agree.
///
/// An unknown extension is accepted where the first bytes identify the format. Of formats with the same
/// extension the first bytes decide, and the last of them may begin with anything.
fn find(start: &[u8], extension: Option<&str>) -> Result<&'static Format, FileError> {
    let begins = |magic: &&[u8]| start.starts_with(magic);
    let by_content = FORMATS
        .iter()
        .find(|format| format.magic.iter().any(begins));
    let by_name = extension.and_then(|extension| {
        FORMATS
            .iter()
            .rfind(|format| format.extensions.contains(&extension))
    });
    let agrees = |format: &Format| extension.is_some_and(|said| format.extensions.contains(&said));
    let other = |found: String| FileError::OtherContent {
        extension: extension.unwrap_or_default().to_owned(),
        found,
    };
    match (by_content, by_name) {
        (Some(found), Some(_)) if !agrees(found) => Err(other(format!("a {}", found.name))),
        (Some(found), _) => Ok(found),
        (None, Some(said)) => {
            let stranger = UNSUPPORTED.iter().find(|(magic, _)| begins(magic));
            match stranger {
                Some((_, name)) => Err(other(format!("a {name}"))),
                None if said.magic.is_empty() || start.is_empty() => Ok(said),
                None => Err(other(format!("no {}", said.name))),
            }
        }
        (None, None) => Err(match extension {
            Some(extension) => FileError::NotInThisVersion {
                extension: extension.to_owned(),
            },
            None => FileError::NoExtension,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A file of another program for each format, but for arrays.
    const GOOD: [&[u8]; 27] = [
        include_bytes!("../../../tests/files/pillow_16.png"),
        include_bytes!("../../../tests/files/pypng_interlaced.png"),
        include_bytes!("../../../tests/files/tifffile_16.tif"),
        include_bytes!("../../../tests/files/tifffile_deflate.tif"),
        include_bytes!("../../../tests/files/pillow_lzw.tif"),
        include_bytes!("../../../tests/files/tifffile_planes.tif"),
        include_bytes!("../../../tests/files/tifffile_packbits.tif"),
        include_bytes!("../../../tests/files/gwyddion.gsf"),
        include_bytes!("../../../tests/files/gwyfile_mask.gwy"),
        include_bytes!("../../../tests/files/gdal_text.grd"),
        include_bytes!("../../../tests/files/gdal_6.grd"),
        include_bytes!("../../../tests/files/gdal_7.grd"),
        include_bytes!("../../../tests/files/surfalize_text.sdf"),
        include_bytes!("../../../tests/files/surfalize_binary.sdf"),
        include_bytes!("../../../tests/files/surfalize_holes.sur"),
        include_bytes!("../../../tests/files/surfalize.al3d"),
        include_bytes!("../../../tests/files/bruker_5.spm"),
        include_bytes!("../../../tests/files/bruker_10.spm"),
        include_bytes!("../../../tests/files/asylum.ibw"),
        include_bytes!("../../../tests/files/nanosurf.nid"),
        include_bytes!("../../../tests/files/zygo.dat"),
        include_bytes!("../../../tests/files/wyko.opd"),
        include_bytes!("../../../tests/files/mountains.x3p"),
        include_bytes!("../../../tests/files/description.vk6"),
        include_bytes!("../../../tests/files/gwyddion.txt"),
        include_bytes!("../../../tests/files/gdal.xyz"),
        include_bytes!("../../../tests/files/sensofar.plu"),
    ];

    /// Extensions of those that no first bytes tell.
    const NAMED: [&str; 3] = ["txt", "xyz", "plu"];

    fn opened(format: &Format, bytes: &[u8], opening: Opening) -> Result<Map, FileError> {
        let source = std::io::Cursor::new(bytes.to_vec());
        (format.read)(Bytes::new(source, bytes.len(), opening))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        /// Any changed or missing bytes give an error or a complete matrix, and by rows the same.
        #[test]
        fn modified_files_give_an_error_or_a_matrix(
            which in 0..GOOD.len(),
            changes in prop::collection::vec((0.0..1.0_f64, 0..3_u8, any::<u8>()), 0..5),
            kept in prop_oneof![3 => Just(1.0), 1 => 0.0..1.0_f64],
        ) {
            let mut bytes = GOOD[which].to_vec();
            let told = GOOD.len() - NAMED.len();
            let extension = which.checked_sub(told).map(|index| NAMED[index]);
            let format = find(&bytes, extension).unwrap();
            for (place, near_start, byte) in changes {
                // Two of three changes hit the header, where lengths and counts stand.
                let reach = if near_start == 0 { bytes.len() } else { bytes.len().min(400) };
                bytes[(place * reach as f64) as usize] = byte;
            }
            bytes.truncate((kept * bytes.len() as f64) as usize);
            let by_rows = opened(format, &bytes, Opening::ByRows).and_then(Map::read);
            match (opened(format, &bytes, Opening::Whole).and_then(Map::read), by_rows) {
                (Ok(matrix), Ok(by_rows)) => {
                    prop_assert_eq!(matrix.values.len(), matrix.rows * matrix.columns);
                    let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits();
                    prop_assert!(matrix.values.iter().zip(&by_rows.values).all(same));
                    prop_assert_eq!(matrix.split().1, by_rows.split().1);
                }
                (Err(error), Err(by_rows)) => {
                    prop_assert!(!error.to_string().contains('\n'));
                    prop_assert_eq!(error.to_string(), by_rows.to_string());
                }
                (_, by_rows) => prop_assert!(false, "by rows {:?}", by_rows.map(|map| map.rows)),
            }
        }
    }

    /// Of every file rows that are read some at a time are those of the whole, and no number is held before.
    #[test]
    fn rows_are_those_of_the_whole() {
        for (which, bytes) in GOOD.iter().enumerate() {
            let told = GOOD.len() - NAMED.len();
            let extension = which.checked_sub(told).map(|index| NAMED[index]);
            let format = find(bytes, extension).unwrap();
            let open = |opening| opened(format, bytes, opening);
            let all = open(Opening::Whole).and_then(Map::read);
            // A build without images reads none.
            if cfg!(not(feature = "images")) && matches!(all, Err(FileError::NotSupported { .. })) {
                continue;
            }
            let all = all.unwrap();
            let map = open(Opening::ByRows).unwrap();
            assert!(matches!(map.values, Numbers::Rows(_)), "{}", format.name);
            let mut rows = map.values.into_rows();
            for part in all.values.chunks(3 * all.columns) {
                let mut found = vec![0.0; part.len()];
                rows.next(&mut found).unwrap();
                let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits();
                assert!(found.iter().zip(part).all(same), "{}", format.name);
            }
            let seen = open(Opening::Glance).unwrap();
            if extension == Some("xyz") {
                // As many points, as a square.
                assert_eq!([seen.rows, seen.columns], [11, 10]);
            } else {
                assert_eq!(
                    [seen.rows, seen.columns],
                    [all.rows, all.columns],
                    "{}",
                    format.name
                );
            }
        }
    }

    #[test]
    #[cfg(feature = "images")]
    fn headers_claim_their_points() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files");
        for name in [
            "numpy_half.npy",
            "mountains.x3p",
            "pillow_16.png",
            "tifffile_16.tif",
            "description.vk4",
            "description.vk6",
        ] {
            assert_eq!(claimed_points(&folder.join(name)), Some([12, 9]), "{name}");
        }
    }

    #[test]
    fn extensions_and_first_bytes_are_unique() {
        for (index, format) in FORMATS.iter().enumerate() {
            for other in &FORMATS[index + 1..] {
                // Of two with one extension the first bytes of one, or its lack of any, must tell.
                let shared = |extension| other.extensions.contains(extension);
                let told_apart = !format.magic.is_empty();
                assert!(
                    told_apart || !format.extensions.iter().any(shared),
                    "{}",
                    format.name
                );
                for magic in format.magic {
                    let clash =
                        |other: &&[u8]| magic.starts_with(other) || other.starts_with(magic);
                    assert!(!other.magic.iter().any(clash), "{}", format.name);
                }
            }
        }
    }
}
