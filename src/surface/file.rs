//! Heights from a file: what kind it is, its numbers, and what the scene wants done with them.

use std::fs::{self, File};
use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::Path;

use super::error::FileError;
use super::matrix::Matrix;
use super::statistics::edge_jumps;
use super::{detrend, fill, npy, text};
use crate::grid::Grid;
use crate::scene::{Boundary, Fill, HeightFileScene};

/// Extensions of text matrices.
const TEXT: [&str; 5] = ["txt", "csv", "tsv", "dat", "asc"];

/// Longest text file taken, 4 GiB: numbers of it take twice the memory besides.
const LONGEST_TEXT: u64 = 1 << 32;

/// Relative difference up to which two sizes agree: files write a few digits.
const SIZE_MARGIN: f64 = 1e-3;

/// Jump between opposite edges, in steps between neighbours, from which on a map does not repeat.
///
/// A single wave whose steepest flank lies on the edge reaches 1.4.
const EDGE_JUMP: f64 = 3.0;

/// First bytes of files that may come under a wrong name, with what they are.
const SIGNATURES: [(&[u8], &str); 9] = [
    (npy::MAGIC, "a NumPy array (.npy)"),
    (b"PK\x03\x04", "a ZIP archive (.npz, .xlsx, .x3p)"),
    (b"\x89PNG", "a PNG image"),
    (b"\x89HDF", "HDF5 data"),
    (b"\xFF\xD8\xFF", "a JPEG image"),
    (b"II*\0", "a TIFF image"),
    (b"MM\0*", "a TIFF image"),
    (b"Gwyddion Simple Field", "a Gwyddion simple field (.gsf)"),
    (b"\x1F\x8B", "gzip-compressed data"),
];

/// Heights read from a file, ready to be added.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct HeightMap {
    /// Heights, m, shape `[ny, nx]`, row-major.
    pub(super) heights: Vec<f64>,
    /// Points along x and y.
    pub(super) points: [usize; 2],
    /// Size along x and y, m, where the file says it.
    pub(super) size: Option<[f64; 2]>,
    /// What the author should know.
    pub(super) warnings: Vec<String>,
}

impl HeightMap {
    /// Refuses a map with other points than `points` (x, y).
    pub(super) fn compare_points(
        &self,
        points: [usize; 2],
        against: &'static str,
    ) -> Result<(), FileError> {
        if self.points == points {
            return Ok(());
        }
        let [columns, rows] = self.points;
        Err(FileError::OtherPoints {
            columns,
            rows,
            against,
            points,
            hint: if [rows, columns] == points {
                "; rows of a file are y and columns x: transpose it, or swap the two numbers"
            } else {
                "; leave points out to take those of the file"
            },
        })
    }

    /// Refuses a map that says another size than `size` (x, y), m.
    pub(super) fn compare_size(
        &self,
        size: [f64; 2],
        against: &'static str,
    ) -> Result<(), FileError> {
        match self.size {
            Some(found) if (0..2).any(|i| (found[i] - size[i]).abs() > SIZE_MARGIN * size[i]) => {
                Err(FileError::OtherSize {
                    found,
                    against,
                    size,
                })
            }
            _ => Ok(()),
        }
    }
}

/// Reads the height map of a scene: numbers, missing pixels, unit and scale, trend.
///
/// # Errors
/// See [`FileError`].
pub(super) fn read(scene: &HeightFileScene, boundary: Boundary) -> Result<HeightMap, FileError> {
    for (name, value) in [("unit", scene.unit), ("scale", scene.scale)] {
        if !value.is_finite() || value == 0.0 {
            return Err(FileError::Factor { name, value });
        }
    }
    let matrix = read_matrix(&scene.path)?;
    let (rows, columns) = (matrix.rows, matrix.columns);
    let mut heights = matrix.values;
    let mut warnings = matrix.warnings;
    fill_missing(
        &mut heights,
        rows,
        columns,
        scene.fill,
        boundary,
        &mut warnings,
    )?;

    let unit = matrix.unit.unwrap_or(scene.unit);
    if unit != scene.unit && scene.unit != 1.0 {
        warnings.push(format!(
            "the file says that its numbers are in units of {unit:e} m, which is used in place of unit = {:e} m",
            scene.unit
        ));
    }
    let factor = unit * scene.scale;
    heights.iter_mut().for_each(|height| *height *= factor);
    detrend::detrend(&mut heights, rows, columns, scene.detrend);
    if boundary == Boundary::Periodic {
        warn_of_edges(&heights, [columns, rows], &mut warnings);
    }
    Ok(HeightMap {
        heights,
        points: [columns, rows],
        size: matrix.size,
        warnings,
    })
}

/// The numbers of a file as they stand there.
fn read_matrix(path: &Path) -> Result<Matrix, FileError> {
    // What the path is comes before what its name says: a folder is no unknown kind of file.
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
    let extension = path
        .extension()
        .map(|extension| extension.to_string_lossy().to_ascii_lowercase())
        .ok_or(FileError::NoExtension)?;
    let is_text = TEXT.contains(&extension.as_str());
    if !is_text && extension != "npy" {
        return Err(FileError::NotInThisVersion { extension });
    }
    let length = metadata.len();
    if length == 0 {
        return Err(FileError::Empty);
    }
    let mut file = BufReader::new(File::open(path).map_err(FileError::Read)?);
    let start = file.fill_buf().map_err(FileError::Read)?;
    let signature = SIGNATURES
        .iter()
        .find(|(bytes, _)| start.starts_with(bytes));
    match signature {
        Some((bytes, _)) if !is_text && *bytes == npy::MAGIC => npy::read(file, length),
        Some((_, found)) => Err(FileError::OtherContent { extension, found }),
        None if is_text => {
            if length > LONGEST_TEXT {
                return Err(FileError::TextTooLong { bytes: length });
            }
            let mut bytes = Vec::new();
            // A file that grows meanwhile is read as long as it was.
            file.take(length)
                .read_to_end(&mut bytes)
                .map_err(FileError::Read)?;
            text::read(&bytes)
        }
        None => Err(FileError::OtherContent {
            extension,
            found: "no NumPy array",
        }),
    }
}

/// Fills missing pixels, or refuses them.
fn fill_missing(
    values: &mut [f64],
    rows: usize,
    columns: usize,
    fill: Fill,
    boundary: Boundary,
    warnings: &mut Vec<String>,
) -> Result<(), FileError> {
    let points = values.len();
    let missing = |value: &f64| !value.is_finite();
    let Some(first) = values.iter().position(missing) else {
        return Ok(());
    };
    let count = values.iter().filter(|value| missing(value)).count();
    match fill {
        Fill::None => Err(FileError::Missing {
            count,
            points,
            infinite: values.iter().filter(|value| value.is_infinite()).count(),
            row: first / columns + 1,
            column: first % columns + 1,
        }),
        Fill::Interpolate if count == points => Err(FileError::AllMissing { points }),
        Fill::Interpolate => {
            fill::interpolate(values, rows, columns, boundary == Boundary::Periodic);
            warnings.push(format!(
                "{count} of {points} pixels ({:.2} %) were missing and are interpolated",
                100.0 * count as f64 / points as f64
            ));
            Ok(())
        }
    }
}

/// Warns of a map whose opposite edges do not match.
fn warn_of_edges(heights: &[f64], points: [usize; 2], warnings: &mut Vec<String>) {
    // Jumps are compared with steps of the same map: lengths do not matter.
    let grid = Grid::new(points, [1.0, 1.0]);
    for (axis, (jump, step)) in ["x", "y"].into_iter().zip(edge_jumps(&grid, heights)) {
        // Rounding of a detrended plane is no jump.
        let noise = 1e-12 * heights.iter().fold(0.0_f64, |most, h| most.max(h.abs()));
        if jump > EDGE_JUMP * step && jump > noise {
            warnings.push(format!(
                "the edges across {axis} do not match: rms jump {jump:.3e} m against {step:.3e} m between \
                 neighbours; on a periodic grid this is a step in the surface (detrend, window the map, or \
                 take boundary = \"free\")"
            ));
        }
    }
}
