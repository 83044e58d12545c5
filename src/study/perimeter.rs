//! The perimeter of a contact, counted in edges between pixels.

use std::f64::consts::{LN_2, PI};

use super::evaluation::PointState;
use crate::backend::{BackendError, Share, host_fields};
use crate::grid::Boundary;

/// Part of a pixel, for each of its edges on the perimeter, by which the staircase of pixels makes a contact too wide
/// (Yastrebov, Anciaux & Molinari 2017, doi:10.1016/j.triboint.2017.04.023).
pub(super) const STAIRCASE: f64 = (PI - 1.0 + LN_2) / 24.0;

/// Where points in contact lie beside points that are not; the rows wrap on a periodic grid.
pub(super) struct Perimeter<'a> {
    points: &'a [PointState],
    share: &'a Share,
    wraps: bool,
    /// Which points touch in the rows before and after those of this rank; empty where the surface ends.
    beside: [Vec<u8>; 2],
}

impl<'a> Perimeter<'a> {
    /// That of the points of this rank.
    ///
    /// # Errors
    /// Another rank has ended.
    pub fn new(
        points: &'a [PointState],
        share: &'a Share,
        boundary: Boundary,
    ) -> Result<Self, BackendError> {
        let [nx, ny] = share.surface();
        let rows = share.surface_rows();
        let wraps = boundary == Boundary::Periodic && ny > 1;
        let as_bytes = |row: &[PointState]| row.iter().map(|point| *point as u8).collect();
        let first: Vec<u8> = as_bytes(&points[..nx.min(points.len())]);
        let last: Vec<u8> = as_bytes(&points[points.len().saturating_sub(nx)..]);
        let [mut before, mut after] = share.surface_rows_around(&first, &last)?;
        if rows.start == 0 && !wraps {
            before.clear();
        }
        if rows.end == ny && !wraps {
            after.clear();
        }
        Ok(Perimeter {
            points,
            share,
            wraps: boundary == Boundary::Periodic && nx > 1,
            beside: [before, after],
        })
    }

    fn row(&self, y: usize) -> &[PointState] {
        let nx = self.share.surface()[0];
        &self.points[y * nx..(y + 1) * nx]
    }

    /// How many edges it has, on all ranks.
    pub fn edges(&self) -> usize {
        let count = self.share.surface_rows().len();
        let edges_of_row = |y: usize| {
            let row = self.row(y);
            let mut edges = differing(touches(row), touches(&row[1..]));
            if self.wraps {
                edges += differing(touches(&row[row.len() - 1..]), touches(row));
            }
            edges
                + match y + 1 < count {
                    true => differing(touches(row), touches(self.row(y + 1))),
                    false => differing(touches(row), touching(&self.beside[1])),
                }
        };
        let edges = host_fields::count_in_rows(count, edges_of_row);
        let [edges] = self.share.counts([edges]);
        edges
    }

    /// How many edges a point has on it, which lies in a row of this rank: 0 unless it is in contact.
    pub fn edges_of(&self, x: usize, y: usize) -> usize {
        let row = self.row(y);
        if row[x] != PointState::Contact {
            return 0;
        }
        let open = |point: Option<&PointState>| {
            usize::from(point.is_some_and(|point| *point != PointState::Contact))
        };
        let last = row.len() - 1;
        let left = match x {
            0 if self.wraps => Some(&row[last]),
            _ => x.checked_sub(1).map(|x| &row[x]),
        };
        let right = match x == last && self.wraps {
            true => Some(&row[0]),
            false => row.get(x + 1),
        };
        let beyond = |beside: &[u8]| {
            let point = beside.get(x);
            usize::from(point.is_some_and(|point| *point != PointState::Contact as u8))
        };
        let below = match y.checked_sub(1) {
            Some(y) => open(self.row(y).get(x)),
            None => beyond(&self.beside[0]),
        };
        let above = match y + 1 < self.share.surface_rows().len() {
            true => open(self.row(y + 1).get(x)),
            false => beyond(&self.beside[1]),
        };
        open(left) + open(right) + below + above
    }
}

/// Which points touch.
fn touches(points: &[PointState]) -> impl Iterator<Item = bool> {
    points.iter().map(|point| *point == PointState::Contact)
}

/// The same of a row of another rank.
fn touching(points: &[u8]) -> impl Iterator<Item = bool> {
    let points = points.iter();
    points.map(|&point| point == PointState::Contact as u8)
}

/// How many of the pairs differ.
fn differing(some: impl Iterator<Item = bool>, others: impl Iterator<Item = bool>) -> usize {
    some.zip(others)
        .map(|(one, other)| usize::from(one != other))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::Shape;

    #[test]
    fn edges_wrap_on_a_periodic_grid_only() {
        let mut points = vec![PointState::Separated; 12];
        points[0] = PointState::Contact;
        let share = Share::whole(Shape::whole(4, 3));
        let edges = |boundary| {
            let perimeter = Perimeter::new(&points, &share, boundary).expect("one process");
            assert_eq!(perimeter.edges(), perimeter.edges_of(0, 0));
            assert_eq!(perimeter.edges_of(1, 0), 0);
            perimeter.edges()
        };
        assert_eq!(edges(Boundary::Periodic), 4);
        assert_eq!(edges(Boundary::Free), 2);
    }

    /// Each edge belongs to one point in contact, on grids of one row and one column too.
    #[test]
    fn points_have_all_edges() {
        for [nx, ny] in [[7, 5], [8, 1], [1, 6], [2, 2], [1, 1]] {
            for seed in 1..40_usize {
                let state = |i: usize| match (i * i + seed * i + seed) % 7 < 3 {
                    true => PointState::Contact,
                    false => PointState::Attracted,
                };
                let points: Vec<_> = (0..nx * ny).map(state).collect();
                let share = Share::whole(Shape::whole(nx, ny));
                for boundary in [Boundary::Periodic, Boundary::Free] {
                    let perimeter = Perimeter::new(&points, &share, boundary).expect("one process");
                    let places = (0..ny).flat_map(|y| (0..nx).map(move |x| (x, y)));
                    let sum: usize = places.map(|(x, y)| perimeter.edges_of(x, y)).sum();
                    assert_eq!(perimeter.edges(), sum, "{nx} x {ny}, {seed}, {boundary:?}");
                }
            }
        }
    }
}
