//! Maps from files over several processes, each of which keeps its rows. The first process reads a file some rows at a time and
//! hands each on, so that none holds the map; what is asked of it all do together, each of its rows.

use super::error::SurfaceError;
use super::file::{self, HeightMap};
use super::file_error::FileError;
use super::formats::{self, Numbers, Opening};
use super::matrix::{Map, Matrix, PASSED, Size};
use super::{prepare, profile};
use crate::backend::Share;
use crate::backend::ranks::{RankError, Ranks, agree};
use crate::scene::{Boundary, Edges, HeightFileScene};

/// Points of the map of a file that several processes resample, as it is before; of a text about so many rows.
pub(crate) fn points_before_resampling(scene: &HeightFileScene) -> Option<[usize; 2]> {
    let asked = &scene.preparation;
    asked.resample?;
    let map = formats::glance(&scene.path).ok()?;
    let mut points = match asked.profile {
        true => [map.columns.max(map.rows), 1],
        false => [map.columns, map.rows],
    };
    if let Some(crop) = asked.crop {
        points = [points[0].min(crop[2]), points[1].min(crop[3])];
    }
    Some(match asked.edges {
        Edges::Mirror => prepare::mirrored(points),
        _ => points,
    })
}

/// The same file with heights of black and white.
pub(super) fn with_ends(scene: &HeightFileScene, [black, white]: [f64; 2]) -> HeightFileScene {
    HeightFileScene {
        black: Some(black),
        white: Some(white),
        ..scene.clone()
    }
}

/// How the map of a file is read, and where its rows go.
pub(super) struct Reading<'a> {
    /// The file, and what is asked of it where rows are read.
    pub scene: &'a HeightFileScene,
    /// What lies beyond the edges of the map.
    pub boundary: Boundary,
    /// The rows of so many points that this process holds.
    pub share: &'a dyn Fn([usize; 2]) -> Share,
    /// Points of the grid over whose rows the one of a profile is repeated.
    pub repeats: Option<[usize; 2]>,
    /// Reads the whole of a file.
    pub whole: &'a dyn Fn() -> Result<HeightMap, FileError>,
    /// Black and white of a grey image of which the scene says nothing, if that is no mistake, as of factors.
    pub shades: Option<[f64; 2]>,
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
        file::check_factors(self.scene).map_err(self.wrong)?;
        let anyone = (self.share)([1, 1]);
        // They note together which process has ended.
        let share_of = |points| anyone.of((self.share)(points).shape());
        let mut map = match anyone.ranks() {
            None => (self.whole)().map_err(self.wrong)?,
            Some(ranks) => {
                let opened = self.of_first(ranks, || {
                    let map = formats::open_map(&self.scene.path, Opening::ByRows)?;
                    if self.scene.preparation.profile {
                        return Ok(profile::to_profile(map)?.into());
                    }
                    Ok(map)
                })?;
                self.by_rows(ranks, opened, &share_of)?
            }
        };
        if let Some(points) = self.repeats {
            let from = share_of(map.points);
            map.points[1] = points[1];
            let fits = map.compare_points(points, "[grid] points", file::OTHER_POINTS);
            fits.map_err(self.wrong)?;
            // One that has ended is seen below.
            let _ = map.repeat(&from, &share_of(points));
            if let Some(error) = anyone.failure() {
                return Err(error.into());
            }
        }
        Ok(map)
    }

    /// What the first process finds in the file; it and the others have the same errors.
    fn of_first<T>(
        &self,
        ranks: &dyn Ranks,
        find: impl FnOnce() -> Result<T, FileError>,
    ) -> Result<Option<T>, SurfaceError> {
        let anyone = (self.share)([1, 1]);
        let found = if anyone.is_first() {
            find().map(Some)
        } else {
            Ok(None)
        };
        if let Some(error) = anyone.failure() {
            return Err(error.into());
        }
        agree(ranks, found.map_err(self.wrong))
    }

    /// The first process, which has opened the file, hands on some rows at a time.
    fn by_rows(
        &self,
        ranks: &dyn Ranks,
        opened: Option<Map>,
        share_of: &dyn Fn([usize; 2]) -> Share,
    ) -> Result<HeightMap, SurfaceError> {
        let (numbers, header) = opened.map(Map::split).unzip();
        let mut header = told_header(&share_of([1, 1]), header)?;
        let points = [header.columns, header.rows];
        let [columns, rows] = points;
        let kept = self.scene.preparation.crop.unwrap_or([0, 0, columns, rows]);
        let fits = (self.fits)(points).and_then(|()| prepare::check_crop(kept, points));
        fits.map_err(self.wrong)?;
        if self.shades.is_some() {
            file::expect_factors(header.unit).map_err(self.wrong)?;
        }
        let [x, y, nx, ny] = kept;
        header.size = header
            .size
            .map(|size| prepare::cropped_size(kept, points, size));
        [header.columns, header.rows] = [nx, ny];
        let share = share_of([nx, ny]);

        let mut numbers = numbers.map(Numbers::into_rows);
        let mut read = Ok(());
        let mut lines = Vec::new();
        let mut next = |count: usize, lines: &mut Vec<f64>| {
            lines.resize(count * columns, 0.0);
            if let (Ok(()), Some(numbers)) = (&read, &mut numbers) {
                read = numbers.next(lines);
            }
        };
        let at_once = (PASSED / columns).max(1);
        if share.is_first() {
            for start in (0..y).step_by(at_once) {
                next(at_once.min(y - start), &mut lines);
            }
        }
        // To the end, whatever becomes of what is read: the other processes take all.
        let heights = share.from_first(true, &mut |values: &mut [f64]| {
            next(values.len() / nx, &mut lines);
            let kept = lines.chunks_exact(columns).map(|line| &line[x..x + nx]);
            for (row, line) in values.chunks_exact_mut(nx).zip(kept) {
                row.copy_from_slice(line);
            }
        });
        if let Some(error) = share.failure() {
            return Err(error.into());
        }
        agree(ranks, read.map_err(self.wrong))?;
        let scene = match self.shades {
            Some(shades) if header.grey => &with_ends(self.scene, shades),
            _ => self.scene,
        };
        let matrix = header.with(heights.unwrap_or_default());
        let map = file::heights_of(scene, self.boundary, matrix, share_of);
        if let Some(error) = share.failure() {
            return Err(error.into());
        }
        map.map_err(self.wrong)
    }
}

/// What the first process knows of a map, on all; its warnings stay there.
fn told_header(anyone: &Share, own: Option<Matrix<()>>) -> Result<Matrix<()>, RankError> {
    let numbers = own.as_ref().map(|own| {
        let (kind, [lx, ly]) = match own.size {
            None => (0.0, [0.0; 2]),
            Some(Size::Metres(size)) => (1.0, size),
            Some(Size::LikeHeights(size)) => (2.0, size),
        };
        let [columns, rows] = [own.columns, own.rows].map(|count| count as f64);
        let has_unit = f64::from(u8::from(own.unit.is_some()));
        let unit = own.unit.unwrap_or_default();
        let grey = f64::from(u8::from(own.grey));
        [columns, rows, kind, lx, ly, has_unit, unit, grey]
    });
    let [columns, rows, kind, lx, ly, has_unit, unit, grey] = anyone.told(numbers);
    if let Some(error) = anyone.failure() {
        return Err(error);
    }
    Ok(Matrix {
        size: match kind {
            1.0 => Some(Size::Metres([lx, ly])),
            2.0 => Some(Size::LikeHeights([lx, ly])),
            _ => None,
        },
        unit: (has_unit == 1.0).then_some(unit),
        grey: grey == 1.0,
        warnings: own.map(|own| own.warnings).unwrap_or_default(),
        ..Matrix::new((), [rows as usize, columns as usize])
    })
}
