//! Errors of a scene's surface.

use crate::backend::ranks::RankError;
use std::path::PathBuf;

use thiserror::Error;

use super::file_error::FileError;
use super::{MOST_POINTS, MapError};

/// Why the heights of a scene cannot be built.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SurfaceError {
    /// Another process of the same contact has ended.
    #[error(transparent)]
    Rank(#[from] RankError),
    /// The scene has no `[[surface]]`.
    #[error("the scene has no [[surface]]; for a flat one write kind = \"flat\"")]
    Empty,
    /// Neither the scene nor a file says how many points there are.
    #[error(
        "[grid] points is missing, and no [[surface]] of kind \"file\" carries it; write points = 512"
    )]
    PointsMissing,
    /// Neither the scene nor a file says how large the grid is.
    #[error(
        "[grid] size is missing, and no height file of this scene carries it; write size = \"10 um\""
    )]
    SizeMissing,
    /// A number of points outside the limits of a grid or of memory.
    #[error(
        "[grid] points = [{}, {}] is not possible: both must be at least 1 and their product at most {}",
        points[0], points[1], MOST_POINTS
    )]
    Points {
        /// Points along x and y.
        points: [usize; 2],
    },
    /// A size that is not a pair of finite, positive lengths.
    #[error("[grid] size = [{:e}, {:e}] m must be two lengths between 1e-30 and 1e30 m; check the unit", size[0], size[1])]
    Size {
        /// Size along x and y, m.
        size: [f64; 2],
    },
    /// The heights do not fit into this machine's memory.
    #[error("[grid] points = [{}, {}]: {} bytes of heights do not fit into memory; take fewer points",
        points[0], points[1], points[0] * points[1] * size_of::<f64>())]
    Memory {
        /// Points along x and y.
        points: [usize; 2],
    },
    /// One part of the surface is wrong.
    #[error("[[surface]] {part}: {problem}")]
    Part {
        /// Number of the part, from 1.
        part: usize,
        /// What is wrong with it.
        problem: Box<PartError>,
    },
    /// The map of `[adhesion]` is wrong.
    #[error("[adhesion] map {}: {problem}", path.display())]
    AdhesionMap {
        /// The file; empty for a pattern.
        path: PathBuf,
        /// What is wrong with it.
        problem: Box<MapError>,
    },
    /// The sum of the parts overflows.
    #[error(
        "the heights are not finite, or exceed 1e30 m, at row {row}, column {column} (counted from 1): a length of a [[surface]] is too large"
    )]
    NotFinite {
        /// Row (y), from 1.
        row: usize,
        /// Column (x), from 1.
        column: usize,
    },
}

/// What is wrong with one `[[surface]]` part.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PartError {
    /// A length that must be positive and finite.
    #[error("{name} = {value} must be a positive, finite number")]
    NotPositive {
        /// The key.
        name: &'static str,
        /// Its value, SI units.
        value: f64,
    },
    /// A number that must be finite.
    #[error("{name} = {value} must be a finite number")]
    NotFinite {
        /// The key.
        name: &'static str,
        /// Its value, SI units.
        value: f64,
    },
    /// A cone that is a needle or a plane.
    #[error("half_angle = {degrees} degrees must lie between 0 and 90")]
    HalfAngle {
        /// Angle between axis and flank, degrees.
        degrees: f64,
    },
    /// Waves that are not periodic on a periodic grid.
    #[error(
        "wavelength = {wavelength:e} m along {axis} does not divide the periodic size {size:e} m: \
         {waves:.6} waves; the nearest that does is {nearest:e} m"
    )]
    WavesDoNotClose {
        /// "x" or "y".
        axis: &'static str,
        /// The wavelength, m.
        wavelength: f64,
        /// Size of the grid along that axis, m.
        size: f64,
        /// Waves across the grid.
        waves: f64,
        /// The nearest wavelength that closes, m.
        nearest: f64,
    },
    /// Waves shorter than two pixels, which alias to longer ones.
    #[error(
        "wavelength = {wavelength:e} m along {axis} is shorter than two pixels of {pixel:e} m; take more points"
    )]
    WavesTooShort {
        /// "x" or "y".
        axis: &'static str,
        /// The wavelength, m.
        wavelength: f64,
        /// Pixel length along that axis, m.
        pixel: f64,
    },
    /// A Hurst exponent outside 0 to 1.
    #[error("hurst = {value} must lie between 0 and 1")]
    Hurst {
        /// The exponent.
        value: f64,
    },
    /// Wavelengths in the wrong order.
    #[error(
        "longest = {longest:e} m, rolloff = {rolloff:e} m, shortest = {shortest:e} m: \
         needed is longest >= rolloff >= shortest"
    )]
    BandOrder {
        /// Longest wavelength, m.
        longest: f64,
        /// Roll-off wavelength, m.
        rolloff: f64,
        /// Shortest wavelength, m.
        shortest: f64,
    },
    /// A band that contains no mode of the cell.
    #[error(
        "no wave of the grid lies between longest = {longest:e} m and shortest = {shortest:e} m; \
         widen the band or take a larger size"
    )]
    BandEmpty {
        /// Longest wavelength, m.
        longest: f64,
        /// Shortest wavelength, m.
        shortest: f64,
    },
    /// A band with too many modes to sum.
    #[error(
        "shortest = {shortest:e} m gives {waves:.3e} waves across the grid, more than can be summed; \
         take at least {least:.3e} m"
    )]
    BandTooLong {
        /// Shortest wavelength, m.
        shortest: f64,
        /// Waves across the longer side of the grid.
        waves: f64,
        /// The least wavelength that can be summed, m.
        least: f64,
    },
    /// A band of which the grid resolves no wave.
    #[error(
        "the grid resolves no wave of the band: pixels of {dx:e} x {dy:e} m against longest = {longest:e} m; \
         take more points"
    )]
    BandNotHeld {
        /// Longest wavelength, m.
        longest: f64,
        /// Pixel length along x, m.
        dx: f64,
        /// Pixel length along y, m.
        dy: f64,
    },
    /// An array of another number of points than the grid.
    #[error(
        "an array of {found} numbers for {} x {} points (x, y), where the grid has {} x {}, which are {}",
        array[0], array[1], points[0], points[1], points[0].saturating_mul(points[1])
    )]
    ArrayPoints {
        /// Numbers in the array.
        found: usize,
        /// Points that it is said to have, along x and y.
        array: [usize; 2],
        /// Points of the grid, along x and y.
        points: [usize; 2],
    },
    /// A height in an array that is no number.
    #[error("the height at row {row}, column {column} (counted from 1) is {value}")]
    ArrayNotFinite {
        /// What stands there.
        value: f64,
        /// Row (y), from 1.
        row: usize,
        /// Column (x), from 1.
        column: usize,
    },
    /// Heights in an array with which one cannot compute.
    #[error(
        "the largest height is {largest:e} m; heights must be 0 or between 1e-30 and 1e30 m: check the unit"
    )]
    ArrayExtreme {
        /// Largest magnitude of a height, m.
        largest: f64,
    },
    /// A height file.
    #[error("{}: {problem}", path.display())]
    File {
        /// Path of the file.
        path: PathBuf,
        /// What is wrong with it.
        problem: FileError,
    },
}
