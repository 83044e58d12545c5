//! Points of a gap along the flow and across it, and the links between those that share a side.

use super::Film;
use crate::grid::Boundary;
use crate::scene::Axis;

/// A gap over its largest value, addressed along the flow.
pub(super) struct Lattice<'a> {
    gap: &'a [f64],
    /// The gap that is 1 here, m.
    pub largest_gap: f64,
    /// Points along the flow and across it.
    along: usize,
    across: usize,
    /// Distance in the field of two neighbours along the flow and across it.
    strides: [usize; 2],
    /// Width over length of a pixel, seen along the flow.
    aspect: f64,
    /// Whether the cell repeats; else the first points along the flow are at the inlet, the last at the outlet.
    pub repeats: bool,
}

/// A point that shares a side with another one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    /// The other point.
    pub to: usize,
    /// Whether it lies in the next cell along the flow (1), in that before (-1), or in the same (0).
    pub cells: i32,
    /// Whether it lies along the flow.
    pub is_along: bool,
}

impl<'a> Lattice<'a> {
    pub fn new(film: &Film<'a>) -> Lattice<'a> {
        let grid = &film.grid;
        let pixel = [grid.dx(), grid.dy()];
        let (along, across, strides, aspect) = match film.axis {
            Axis::X => (grid.nx, grid.ny, [1, grid.nx], pixel[1] / pixel[0]),
            Axis::Y => (grid.ny, grid.nx, [grid.nx, 1], pixel[0] / pixel[1]),
        };
        Lattice {
            gap: film.gap,
            largest_gap: film.gap.iter().fold(0.0, |most: f64, g| most.max(*g)),
            along,
            across,
            strides,
            aspect,
            repeats: film.boundary == Boundary::Periodic,
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.gap.len()
    }

    /// Gap over the largest one; 0 where it is closed.
    pub fn gap(&self, point: usize) -> f64 {
        let gap = self.gap[point];
        if gap > 0.0 {
            gap / self.largest_gap
        } else {
            0.0
        }
    }

    /// Place along the flow and across it.
    fn place(&self, point: usize) -> [usize; 2] {
        if self.strides[0] == 1 {
            [point % self.along, point / self.along]
        } else {
            [point / self.across, point % self.across]
        }
    }

    /// The neighbours that come after a point, along the flow and across it: each pair of neighbours is told once.
    pub fn forward(&self, point: usize) -> impl Iterator<Item = Link> + use<> {
        let [along, across] = self.place(point);
        [
            self.neighbour(point, along, self.along, 0, true),
            self.neighbour(point, across, self.across, 1, true),
        ]
        .into_iter()
        .flatten()
    }

    /// All neighbours of a point.
    pub fn links(&self, point: usize) -> impl Iterator<Item = Link> + use<> {
        let [along, across] = self.place(point);
        [
            self.neighbour(point, along, self.along, 0, true),
            self.neighbour(point, along, self.along, 0, false),
            self.neighbour(point, across, self.across, 1, true),
            self.neighbour(point, across, self.across, 1, false),
        ]
        .into_iter()
        .flatten()
    }

    /// The neighbour after a point or before it, where `place` of `count` is its place in that direction.
    fn neighbour(
        &self,
        point: usize,
        place: usize,
        count: usize,
        direction: usize,
        after: bool,
    ) -> Option<Link> {
        let stride = self.strides[direction];
        let is_along = direction == 0;
        let is_last = if after {
            place + 1 == count
        } else {
            place == 0
        };
        let (to, cells) = match (is_last, after) {
            (false, true) => (point + stride, 0),
            (false, false) => (point - stride, 0),
            (true, _) if !self.repeats => return None,
            (true, true) => (point - place * stride, 1),
            (true, false) => (point + (count - 1) * stride, -1),
        };
        Some(Link {
            to,
            cells: if is_along { cells } else { 0 },
            is_along,
        })
    }

    /// What the face between two open neighbours conducts: half a pixel of each gap, one after the other.
    pub fn face(&self, point: usize, link: Link) -> f64 {
        let [here, there] = [self.gap(point), self.gap(link.to)].map(|gap| gap.powi(3));
        let between = 2.0 * here * there / (here + there);
        if link.is_along {
            between * self.aspect
        } else {
            between / self.aspect
        }
    }

    /// What lies between a point and the inlet, and the outlet, half a pixel away; 0 where it is not at the edge.
    pub fn ends(&self, point: usize) -> [f64; 2] {
        if self.repeats {
            return [0.0; 2];
        }
        let [along, _] = self.place(point);
        let half = 2.0 * self.gap(point).powi(3) * self.aspect;
        [along == 0, along + 1 == self.along].map(|is_end| if is_end { half } else { 0.0 })
    }
}
