//! Maps from files over several processes, each of which keeps its rows. A file whose rows lie one after another, and of
//! which nothing is asked that takes more than some rows at once, is read by all, each its own rows. Any other one is read
//! whole by the first process alone, which hands the rows on.

use super::error::{FileError, SurfaceError};
use super::file::{self, HeightMap};
use super::formats;
use crate::backend::Share;
use crate::backend::ranks::{Ranks, agree};
use crate::scene::{Boundary, Edges, Fill, HeightFileScene};

/// Whether each process reads its own rows of a file.
pub(crate) fn is_by_rows(scene: &HeightFileScene) -> bool {
    points_by_rows(scene).is_some()
}

/// Points along x and y of such a file.
fn points_by_rows(scene: &HeightFileScene) -> Option<[usize; 2]> {
    let asked = &scene.preparation;
    // These look at points beside each other, or make other points.
    let takes_all = asked.profile
        || asked.crop.is_some()
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
    /// Reads the whole.
    pub whole: &'a dyn Fn() -> Result<HeightMap, FileError>,
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
            let mut map = (self.whole)().map_err(self.wrong)?;
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
        let share = (self.share)(points);
        let read = formats::read_rows(&self.scene.path, points, share.surface_rows());
        let matrix = agree(ranks, read.map_err(self.wrong))?;
        let map = file::heights_of(self.scene, self.boundary, matrix, &share);
        if let Some(error) = share.failure() {
            return Err(error.into());
        }
        map.map_err(self.wrong)
    }

    /// The first process reads the whole and hands the rows on.
    fn handed_on(&self, ranks: &dyn Ranks) -> Result<HeightMap, SurfaceError> {
        let leads = (self.share)([1, 1]).is_first();
        let read = if leads {
            (self.whole)().map(Some)
        } else {
            Ok(None)
        };
        let read = agree(ranks, read.map_err(self.wrong))?;
        let outline = read.as_ref().map(|map| {
            let [nx, ny] = map.points.map(|n| n as f64);
            let [lx, ly] = map.size.unwrap_or([0.0; 2]);
            [nx, self.repeats.map_or(ny, |rows| rows as f64), lx, ly]
        });
        let anyone = (self.share)([1, 1]);
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
