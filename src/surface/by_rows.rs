//! Maps from files over several processes, each of which keeps its rows. A file whose rows lie one after another, and of
//! which nothing is asked that takes more than some rows at once, is read by all, each its own rows. Any other one is read
//! whole by the first process alone, which hands the rows on, up to a number of points that is small beside the slab of a
//! contact for which several processes are worth their while.

use std::fs;
use std::path::Path;

use super::error::{FileError, SurfaceError};
use super::file::{self, HeightMap};
use super::{formats, prepare};
use crate::backend::Share;
use crate::backend::ranks::{Ranks, agree};
use crate::scene::{Boundary, Edges, Fill, HeightFileScene};

/// Points of the largest file that the first of several processes reads whole, 4096 x 4096: 128 MiB of heights, a few times as
/// much while it is read, where a slab of a contact that needs several machines has gigabytes.
pub(super) const MOST_WHOLE: usize = 1 << 24;
/// Bytes that a number of a text takes at most, nearly: a longer file has more of them, or says in its header how many.
const LONGEST_NUMBER: u64 = 32;

/// Refuses a file that is too large to be read whole by one of several processes, as far as its header and its length tell.
fn check_whole(path: &Path) -> Result<(), FileError> {
    // What cannot be asked for its length is the reader's to refuse.
    let length = fs::metadata(path).map_or(0, |metadata| metadata.len());
    let points = formats::claimed_points(path);
    let is_large = |[columns, rows]: [usize; 2]| columns.saturating_mul(rows) > MOST_WHOLE;
    match points {
        Some(points) if is_large(points) => Err(FileError::Whole {
            points: Some(points),
            length,
        }),
        None if length > LONGEST_NUMBER * MOST_WHOLE as u64 => Err(FileError::Whole {
            points: None,
            length,
        }),
        _ => Ok(()),
    }
}

/// The error of the first file of a scene that several processes refuse, as far as headers and lengths tell.
#[cfg(feature = "cli")]
pub(crate) fn refused_on_ranks(scene: &crate::scene::Scene) -> Option<SurfaceError> {
    use super::{PartError, part_error};
    use crate::scene::{AdhesionMap, SurfacePart};

    let refused = |file: &HeightFileScene| match is_by_rows(file) {
        true => None,
        false => check_whole(&file.path).err(),
    };
    let of_part = |(index, part): (usize, &SurfacePart)| {
        let SurfacePart::File(file) = part else {
            return None;
        };
        let path = file.path.clone();
        let problem = refused(file)?;
        Some(part_error(index, PartError::File { path, problem }))
    };
    let adhesion = scene.adhesion.as_ref();
    let map = || match adhesion?.map.as_ref()? {
        AdhesionMap::File(path) => Some(SurfaceError::AdhesionMap {
            path: path.clone(),
            problem: Box::new(refused(&HeightFileScene::new(path))?.into()),
        }),
        _ => None,
    };
    scene
        .surfaces
        .iter()
        .enumerate()
        .find_map(of_part)
        .or_else(map)
}

/// Whether each process reads its own rows of a file.
pub(crate) fn is_by_rows(scene: &HeightFileScene) -> bool {
    points_by_rows(scene).is_some()
}

/// Points along x and y of such a file.
fn points_by_rows(scene: &HeightFileScene) -> Option<[usize; 2]> {
    let asked = &scene.preparation;
    // These look at points beside each other, or make other points.
    let takes_all = asked.profile
        || asked.outliers.is_some()
        || asked.edges != Edges::None
        || asked.resample.is_some()
        || scene.fill != Fill::None;
    if takes_all {
        return None;
    }
    formats::row_major_points(&scene.path)
}

/// How the map of a file is read, and where its rows go.
pub(super) struct Reading<'a> {
    /// The file, and what is asked of it where rows are read.
    pub scene: &'a HeightFileScene,
    /// What lies beyond the edges of the map.
    pub boundary: Boundary,
    /// The rows of so many points that this process holds.
    pub share: &'a dyn Fn([usize; 2]) -> Share,
    /// Rows over which one row is repeated.
    pub repeats: Option<usize>,
    /// Reads the whole of a file of at most so many points.
    pub whole: &'a dyn Fn(usize) -> Result<HeightMap, FileError>,
    /// Refuses a file of so many points along x and y that is no such map.
    pub fits: &'a dyn Fn([usize; 2]) -> Result<(), FileError>,
    /// The error of the surface that one of the file is.
    pub wrong: &'a dyn Fn(FileError) -> SurfaceError,
}

impl Reading<'_> {
    /// The map, with the rows that this process holds.
    ///
    /// # Errors
    /// As of the whole, on every process; where another one cannot read the file, that it has ended.
    pub fn read(&self) -> Result<HeightMap, SurfaceError> {
        let anyone = (self.share)([1, 1]);
        let Some(ranks) = anyone.ranks() else {
            let mut map = (self.whole)(usize::MAX).map_err(self.wrong)?;
            if let Some(rows) = self.repeats {
                map.repeat(rows);
            }
            return Ok(map);
        };
        // The first one looks at the file, so that all do the same.
        let look =
            || points_by_rows(self.scene).map_or([0.0; 2], |points| points.map(|n| n as f64));
        let points = anyone.told(anyone.is_first().then(look));
        if let Some(error) = anyone.failure() {
            return Err(error.into());
        }
        if points == [0.0; 2] {
            self.handed_on(ranks)
        } else {
            self.own_rows(ranks, points.map(|n| n as usize))
        }
    }

    /// Each process reads its own rows.
    fn own_rows(&self, ranks: &dyn Ranks, points: [usize; 2]) -> Result<HeightMap, SurfaceError> {
        let [columns, rows] = points;
        let kept = self.scene.preparation.crop.unwrap_or([0, 0, columns, rows]);
        let fits = (self.fits)(points).and_then(|()| prepare::check_crop(kept, points));
        fits.map_err(self.wrong)?;
        let [x, y, nx, ny] = kept;
        let share = (self.share)([nx, ny]);
        let own = share.surface_rows();
        let read = formats::read_rows(&self.scene.path, points, y + own.start..y + own.end);
        let mut matrix = agree(ranks, read.map_err(self.wrong))?;
        prepare::keep_columns(&mut matrix, x..x + nx);
        matrix.rows = ny;
        let map = file::heights_of(self.scene, self.boundary, matrix, &share);
        if let Some(error) = share.failure() {
            return Err(error.into());
        }
        map.map_err(self.wrong)
    }

    /// The first process reads the whole and hands the rows on.
    fn handed_on(&self, ranks: &dyn Ranks) -> Result<HeightMap, SurfaceError> {
        let anyone = (self.share)([1, 1]);
        let read = if anyone.is_first() {
            let read = check_whole(&self.scene.path).and_then(|()| (self.whole)(MOST_WHOLE));
            read.map(Some)
        } else {
            Ok(None)
        };
        // All refuse a large one, in the same words.
        let refused = match &read {
            Err(FileError::Whole { points, length }) => {
                let [columns, rows] = points.unwrap_or_default();
                [columns as f64, rows as f64, *length as f64]
            }
            _ => [0.0; 3],
        };
        let refused = anyone.told(anyone.is_first().then_some(refused));
        if let Some(error) = anyone.failure() {
            return Err(error.into());
        }
        if refused != [0.0; 3] {
            let [columns, rows, length] = refused;
            let points = [columns as usize, rows as usize];
            return Err((self.wrong)(FileError::Whole {
                points: (points != [0; 2]).then_some(points),
                length: length as u64,
            }));
        }
        let read = agree(ranks, read.map_err(self.wrong))?;
        let outline = read.as_ref().map(|map| {
            let [nx, ny] = map.points.map(|n| n as f64);
            let [lx, ly] = map.size.unwrap_or([0.0; 2]);
            [nx, self.repeats.map_or(ny, |rows| rows as f64), lx, ly]
        });
        let [nx, ny, lx, ly] = anyone.told(outline);
        if let Some(error) = anyone.failure() {
            return Err(error.into());
        }
        let points = [nx as usize, ny as usize];
        let share = (self.share)(points);
        let mut given = read.iter().flat_map(|map| map.heights.iter().cycle());
        let heights = share.from_first(true, &mut |rows| {
            for (height, given) in rows.iter_mut().zip(&mut given) {
                *height = *given;
            }
        });
        if let Some(error) = share.failure() {
            return Err(error.into());
        }
        Ok(HeightMap {
            heights: heights.unwrap_or_default(),
            points,
            size: (lx > 0.0).then_some([lx, ly]),
            warnings: read.map(|map| map.warnings).unwrap_or_default(),
        })
    }
}
