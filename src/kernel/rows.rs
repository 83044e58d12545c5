//! The points that one call of a twin works on.

use std::ops::Range;

use super::Reduce;
use crate::real::Real;

/// A field read at rows of the kernel's own choice, with its level's shape: all of it, or the rows that a process
/// holds with the one before and the one after.
#[derive(Clone, Copy)]
pub struct Whole<'a, T> {
    /// The values of the held rows, row-major.
    values: &'a [T],
    /// Points along x and y of the level.
    points: [usize; 2],
    /// The held rows: the first one, and how many.
    first: usize,
    count: usize,
    /// The row before them and the one after, on the ring of all rows; empty where all are held.
    edges: [&'a [T]; 2],
}

impl<'a, T> Whole<'a, T> {
    /// A field that is held as a whole.
    pub fn new(values: &'a [T], points: [usize; 2]) -> Self {
        Whole::of_rows(values, points, 0..points[1], [&[]; 2])
    }

    /// No field.
    pub fn none() -> Self {
        Whole::new(&[], [0, 0])
    }

    /// Some rows of a field of so many points, with the row before them and the one after.
    pub fn of_rows(
        values: &'a [T],
        points: [usize; 2],
        rows: Range<usize>,
        edges: [&'a [T]; 2],
    ) -> Self {
        debug_assert_eq!(values.len(), points[0] * rows.len());
        Whole {
            values,
            points,
            first: rows.start,
            count: rows.len(),
            edges,
        }
    }

    /// Points along x and y of its level.
    #[inline(always)]
    pub fn points(&self) -> [usize; 2] {
        self.points
    }

    /// A row: a held one, or one beside them.
    #[inline(always)]
    pub fn row(&self, row: usize) -> &'a [T] {
        let (width, held) = (self.points[0], row.wrapping_sub(self.first));
        if held < self.count {
            &self.values[held * width..(held + 1) * width]
        } else {
            self.edge(row)
        }
    }

    /// The row before the held ones, or the one after.
    #[cold]
    fn edge(&self, row: usize) -> &'a [T] {
        let after = row + 1 != self.first && !(self.first == 0 && row + 1 == self.points[1]);
        self.edges[usize::from(after)]
    }

    /// Some of the held rows.
    #[inline(always)]
    pub fn rows(&self, rows: Range<usize>) -> &'a [T] {
        let width = self.points[0];
        &self.values[(rows.start - self.first) * width..(rows.end - self.first) * width]
    }
}

/// Some full rows of a level, with the fields that a kernel reads and writes there.
pub struct Rows<'a, T> {
    /// Number of the first row.
    pub first: usize,
    /// Points in a row.
    pub width: usize,
    /// Rows.
    pub count: usize,
    /// Surface points along x and y; the others are the pad of a free boundary.
    pub surface: [usize; 2],
    /// The lines of a transform or those that were kept, as the kernel's form says.
    pub lines: &'a mut [T],
    /// Fields read, cut to these rows.
    pub reads: [&'a [T]; 4],
    /// Fields written or updated, cut to these rows.
    pub writes: [&'a mut [T]; 4],
    /// A field read at rows of the kernel's own choice.
    pub whole: Whole<'a, T>,
    /// The field that is read at the neighbours of each point.
    pub around: Whole<'a, T>,
    /// Factors on the law's tension, cut to these rows; empty where the law is the same everywhere.
    pub factor: &'a [T],
    /// Gap of the outer state that is corrected, cut to these rows; empty where the unknown is the gap itself.
    pub outer_gap: &'a [T],
    /// How the kernel's sums are put together.
    pub reduces: &'static [Reduce],
}

impl<T: Real> Rows<'_, T> {
    /// Points in these rows.
    pub fn len(&self) -> usize {
        self.width * self.count
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The layout alone, to walk the points while fields are borrowed.
    pub fn layout(&self) -> Layout {
        Layout {
            first: self.first,
            width: self.width,
            count: self.count,
            surface: self.surface,
        }
    }
}

/// Where rows lie.
#[derive(Clone, Copy)]
pub struct Layout {
    first: usize,
    width: usize,
    count: usize,
    surface: [usize; 2],
}

impl Layout {
    /// The points in order, in stretches that are all surface (true) or all pad.
    pub fn runs(self) -> impl Iterator<Item = (Range<usize>, bool)> {
        // Without a pad all rows are one stretch.
        let whole = self.surface[0] == self.width && self.first + self.count <= self.surface[1];
        let (width, count) = match whole {
            true => (self.width * self.count, 1),
            false => (self.width, self.count),
        };
        (0..count).flat_map(move |row| {
            let surface = match whole {
                true => width,
                false if self.first + row < self.surface[1] => self.surface[0],
                false => 0,
            };
            let (start, end) = (row * width, (row + 1) * width);
            [
                (start..start + surface, true),
                (start + surface..end, false),
            ]
        })
    }

    /// Calls `point(index, in_domain)` for each point in order; `in_domain` is false on the pad.
    #[inline(always)]
    pub fn points(&self, mut point: impl FnMut(usize, bool)) {
        if self.surface[0] == self.width && self.first + self.count <= self.surface[1] {
            for index in 0..self.width * self.count {
                point(index, true);
            }
            return;
        }
        for row in 0..self.count {
            let surface = if self.first + row < self.surface[1] {
                self.surface[0]
            } else {
                0
            };
            let start = row * self.width;
            for index in start..start + surface {
                point(index, true);
            }
            for index in start + surface..start + self.width {
                point(index, false);
            }
        }
    }
}
