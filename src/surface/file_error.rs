//! What is wrong with a height file.

use thiserror::Error;

use super::MOST_POINTS;
use crate::units::{cut, quoted};

/// What is wrong with a height file. Lines, rows and columns count from 1.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FileError {
    /// An unsupported kind of file.
    #[error(
        "height files of kind .{extension} are not in this version; docs/surfaces.md lists those that are, and has \
         one line of Python that converts what SurfaceTopography reads to .npy, which tabor reads"
    )]
    NotInThisVersion {
        /// The extension, lower case.
        extension: String,
    },
    /// A name from which the kind of file cannot be told.
    #[error(
        "the name has no extension and the first bytes are those of no known kind; name it .txt if it is \
         a text matrix, so that its kind is known"
    )]
    NoExtension,
    /// No such file.
    #[error("there is no such file; a path in a scene is relative to the folder of the scene file")]
    NotFound,
    /// A folder in place of a file.
    #[error("this is a folder; path must name one height file")]
    Folder,
    /// A device, pipe or socket in place of a file.
    #[error("this is not a regular file; copy the heights into one")]
    NotRegular,
    /// A file that cannot be read.
    #[error("cannot be read: {0}")]
    Read(#[source] std::io::Error),
    /// An empty file.
    #[error("the file is empty (0 bytes)")]
    Empty,
    /// A file whose content contradicts its extension.
    #[error("the name says .{extension}, but the file holds {found}; give it the right extension")]
    OtherContent {
        /// The extension, lower case.
        extension: String,
        /// What its first bytes say.
        found: String,
    },
    /// A text file with binary content.
    #[error("the file is not text: byte {offset} is 0")]
    Binary {
        /// Offset of the first such byte, from 0.
        offset: usize,
    },
    /// Text in an encoding of two bytes a character.
    #[error("the text is in UTF-16; save it as UTF-8")]
    Utf16,
    /// A file too long to read.
    #[error("{bytes} bytes are too many to read; save the heights as .npy")]
    TooLong {
        /// Length of the file.
        bytes: u64,
    },
    /// The numbers do not fit into this machine's memory.
    #[error("{bytes} bytes do not fit into memory; take a smaller map")]
    Memory {
        /// Bytes asked for.
        bytes: u64,
    },
    /// A binary file that is broken.
    #[error("broken {format} file at byte {offset}: {what}")]
    Broken {
        /// The format, such as `.sur`.
        format: &'static str,
        /// Offset of the mistake, from 0.
        offset: usize,
        /// What is wrong.
        what: String,
    },
    /// A text file of a known format that is broken.
    #[error("broken {format} file, line {line}: {what}")]
    BrokenText {
        /// The format, such as `.sdf`.
        format: &'static str,
        /// Line of the mistake.
        line: usize,
        /// What is wrong.
        what: String,
    },
    /// An image that is broken.
    #[error("broken {format} image: {}", cut(what))]
    BrokenImage {
        /// PNG or TIFF.
        format: &'static str,
        /// What is wrong.
        what: String,
    },
    /// An unsupported variant of a known format.
    #[error("{what} are not in this version; {instead}")]
    NotSupported {
        /// Which form.
        what: &'static str,
        /// What to do.
        instead: &'static str,
    },
    /// Numbers of rows and columns outside the limits of a grid.
    #[error("the file says it has {rows} rows of {columns} columns; both must be at least 1")]
    Counts {
        /// Rows in the file.
        rows: i64,
        /// Columns in the file.
        columns: i64,
    },
    /// A quantity that is not a length.
    #[error(
        "the file gives its {what} in {}, which is not a length; save an image of heights, or the numbers as .npy",
        quoted(unit)
    )]
    NotALength {
        /// Heights, or x and y.
        what: &'static str,
        /// The unit in the file.
        unit: String,
    },
    /// Lengths in place of factors.
    #[error(
        "the file gives its numbers in units of {unit:e} m, and factors have none; save them without a unit"
    )]
    LengthsAsFactors {
        /// Metres in the unit.
        unit: f64,
    },
    /// Points x, y, z that do not form a grid.
    #[error("the points x, y, z do not form a grid: {what}")]
    NotAGrid {
        /// What is wrong.
        what: String,
    },
    /// Places of a profile that are not at equal distances.
    #[error(
        "the distances between the places of the profile are not equal: place {place} is {value}; a profile has one line of heights, or \
         two of places at equal distances and heights"
    )]
    UnevenPlaces {
        /// The first that is elsewhere, from 1.
        place: usize,
        /// Where it is, in its unit.
        value: f64,
    },
    /// A profile of heights and places without heads that say so.
    #[error(
        "the second of its two lines seems to be that of places, since its distances are equal: put the places first, or give the columns \
         heads such as z [nm], x [um]"
    )]
    PlacesBehindHeights,
    /// A grey image without the heights of black and white.
    #[error(
        "this is a grey image: write black and white, the heights of its ends (black = 0, white = \"1 um\")"
    )]
    GreyEndsMissing,
    /// Heights of black and white for a file that is not a grey image.
    #[error("black and white are for grey images; this file holds heights, so leave both out")]
    GreyEndsUnused,
    /// Black and white of the same height.
    #[error(
        "black and white are both {value:e} m: an image of one height; write flat in its place"
    )]
    GreyEndsEqual {
        /// Both heights, m.
        value: f64,
    },
    /// A .npy file that is broken.
    #[error("broken .npy file: {}", cut(what))]
    BrokenNpy {
        /// What is wrong.
        what: String,
    },
    /// An array with other than two dimensions.
    #[error(
        "the array has shape {}; heights need two dimensions, [rows (y), columns (x)]",
        cut(&format!("{shape:?}"))
    )]
    Dimensions {
        /// The shape in the file.
        shape: Vec<u64>,
    },
    /// An array of elements that are not real numbers.
    #[error(
        "elements of type {} are not heights; save them as float32, float64 or an integer type",
        cut(found)
    )]
    ElementType {
        /// The type in the file.
        found: String,
    },
    /// Fewer bytes than the shape asks for.
    #[error(
        "the file is cut short: {rows} rows of {columns} columns need {expected} bytes, there are {found}"
    )]
    Truncated {
        /// Rows of the array.
        rows: usize,
        /// Columns of the array.
        columns: usize,
        /// Bytes that the array needs.
        expected: u64,
        /// Bytes after the header.
        found: u64,
    },
    /// More points than a grid may have.
    #[error("{points} points are too many; at most {} can be taken", MOST_POINTS)]
    TooManyPoints {
        /// Points in the file, or those counted so far.
        points: u64,
    },
    /// A line of a text that is too long for several processes, of which the first holds a line at a time.
    #[error(
        "line {line} has more than {longest} bytes, the longest that is read by several processes; prepare the file once on one process \
         (tabor surface writes heights.npy)"
    )]
    LongLine {
        /// Line of the file.
        line: usize,
        /// Bytes of the longest line that is read.
        longest: u64,
    },
    /// Numbers in another order than that of rows, which are sorted in a temporary file, and no such file.
    #[error(
        "its numbers are not in the order of rows, and cannot be sorted in a temporary file in {}: {source}; TMPDIR names another folder, \
         and tabor surface prepares the file once on one process (heights.npy)",
        std::env::temp_dir().display()
    )]
    Sorting {
        /// What is wrong with the temporary file.
        source: std::io::Error,
    },
    /// More missing pixels or outliers than several processes fill.
    #[error(
        "{count} pixels are missing or stand out, and several processes fill at most {most}; prepare the file once on one process \
         (tabor surface writes heights.npy)"
    )]
    MissingOnRanks {
        /// Pixels to fill.
        count: usize,
        /// The most that are filled.
        most: usize,
    },
    /// No numbers: nothing but comments, or an empty array.
    #[error("the file holds no numbers")]
    NoNumbers,
    /// Rows of different length.
    #[error(
        "line {line} (row {row}) has {found} values where the rows above have {expected}; \
         every row must have as many"
    )]
    Ragged {
        /// Line of the file.
        line: usize,
        /// Row of numbers.
        row: usize,
        /// Its values.
        found: usize,
        /// Values of the first row.
        expected: usize,
    },
    /// A cell that is not a number.
    #[error("line {line} (row {row}), column {column}: \"{text}\" is not a number")]
    NotANumber {
        /// Line of the file.
        line: usize,
        /// Row of numbers.
        row: usize,
        /// Column.
        column: usize,
        /// Its text, cut to 40 characters.
        text: String,
    },
    /// A line scan in place of a map. Points along x and y.
    #[error(
        "{columns} x {rows} points (x, y) are a line scan and no map; write profile = true to take it as a profile \
         that repeats across, or give a map"
    )]
    LineScan {
        /// Points along x.
        columns: usize,
        /// Points along y.
        rows: usize,
    },
    /// A part that is not in the map.
    #[error(
        "crop = [{}, {}, {}, {}] (x, y of the first point, points along x and y) is not within the {columns} x {rows} points of the map",
        crop[0], crop[1], crop[2], crop[3]
    )]
    Crop {
        /// First point along x and y, points along x and y.
        crop: [usize; 4],
        /// Points of the map along x.
        columns: usize,
        /// Points of the map along y.
        rows: usize,
    },
    /// Missing pixels without `fill = "interpolate"`.
    #[error(
        "{count} of {points} pixels are missing ({infinite} of them infinite), the first at row {row}, \
         column {column}; write fill = \"interpolate\" to fill them from their neighbours{}",
        corner([*count, *row, *column], *points)
    )]
    Missing {
        /// Pixels that are not finite.
        count: usize,
        /// All pixels.
        points: usize,
        /// Those of them that are infinite.
        infinite: usize,
        /// Row of the first.
        row: usize,
        /// Column of the first.
        column: usize,
    },
    /// All pixels are missing.
    #[error("all {points} pixels are missing: there is nothing to interpolate from")]
    AllMissing {
        /// All pixels.
        points: usize,
    },
    /// Heights outside the range of supported magnitudes.
    #[error(
        "the largest height is {largest:e} m; heights must be 0 or between 1e-30 and 1e30 m: check the unit and the powers of ten"
    )]
    Extreme {
        /// Largest magnitude of a height, m.
        largest: f64,
    },
    /// A factor that is not a supported number.
    #[error(
        "{name} = {value:e} must be between 1e-30 and 1e30, or minus that; check the powers of ten"
    )]
    Factor {
        /// The key.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The file's number of points differs from the grid's.
    #[error(
        "the map has {columns} x {rows} points (x, y), but {against} has {} x {}{hint}",
        points[0], points[1]
    )]
    OtherPoints {
        /// Columns of the map.
        columns: usize,
        /// Rows of the map.
        rows: usize,
        /// What it disagrees with.
        against: &'static str,
        /// Points of that, x and y.
        points: [usize; 2],
        /// What to do.
        hint: &'static str,
    },
    /// The file's size differs from the grid's.
    #[error(
        "the map says it is {:e} x {:e} m (x, y), but {against} says {:e} x {:e} m; leave size out or correct one",
        found[0], found[1], size[0], size[1]
    )]
    OtherSize {
        /// Size in the file, m.
        found: [f64; 2],
        /// What it disagrees with.
        against: &'static str,
        /// Size of that, m.
        size: [f64; 2],
    },
}

/// What else a map may be of which the first pixel alone is missing.
fn corner(count_and_place: [usize; 3], points: usize) -> &'static str {
    match count_and_place {
        [1, 1, 1] if points > 1 => {
            "; if the first row and the first column are places, crop leaves them out"
        }
        _ => "",
    }
}
