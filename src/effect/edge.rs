//! The edge of a contact: how long it is, and how fast it recedes.

use std::f64::consts::FRAC_PI_4;

use crate::backend::{BackendError, Share};
use crate::grid::{Boundary, Grid};

/// Area in contact and the length of its edge.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Edge {
    /// Area, m^2.
    pub area: f64,
    /// Length of the edge, m.
    pub length: f64,
}

impl Edge {
    /// The edge of the points of a grid that touch.
    ///
    /// Its length is that of the ellipse whose pixels have as much edge along x and along y: a circle's staircase is 4/pi
    /// times as long as the circle, while an edge along the grid, as that of a ridge, has no staircase. By the second formula of
    /// Ramanujan 1914, which is exact for a circle and 4e-4 short for an edge along the grid.
    ///
    /// # Errors
    /// Another rank has ended.
    pub fn new(
        touches: &[bool],
        share: &Share,
        grid: &Grid,
        boundary: Boundary,
    ) -> Result<Edge, BackendError> {
        let (nx, ny) = (grid.nx, grid.ny);
        let wraps = boundary == Boundary::Periodic;
        let touches: Vec<u8> = touches.iter().copied().map(u8::from).collect();
        let after = share.surface_row_after(&touches[..nx.min(touches.len())])?;
        let rows = share.surface_rows();
        let line = |row: usize| match row == rows.len() {
            true => &after[..],
            false => &touches[row * nx..(row + 1) * nx],
        };
        let [along_x, along_y] = share.sums(rows.len(), |row, [along_x, along_y]| {
            let (here, next) = (line(row), line(row + 1));
            let is_followed = rows.start + row + 1 < ny || wraps;
            for x in 0..nx {
                if (x + 1 < nx || wraps) && here[x] != here[(x + 1) % nx] {
                    *along_y += grid.dy();
                }
                if is_followed && here[x] != next[x] {
                    *along_x += grid.dx();
                }
            }
        });
        let staircase = along_x + along_y;
        let narrow = match staircase > 0.0 {
            true => ((along_x - along_y) / staircase).powi(2),
            false => 0.0,
        };
        let longer = 1.0 + 3.0 * narrow / (10.0 + (4.0 - 3.0 * narrow).sqrt());
        let [count] = share.counts([touches.iter().filter(|&&touches| touches > 0).count()]);
        Ok(Edge {
            area: count as f64 * grid.pixel_area(),
            length: FRAC_PI_4 * staircase * longer,
        })
    }

    /// Mean speed at which it recedes to become `later` within `duration` (s), m/s; 0 where the area
    /// does not shrink, and where there is no edge: surfaces in full contact that let go everywhere at once do not peel. With
    /// the mean of the two lengths it is exact for a circle.
    pub fn recession(&self, later: &Edge, duration: f64) -> f64 {
        let lost = self.area - later.area;
        let length = 0.5 * (self.length + later.length);
        if lost <= 0.0 || length <= 0.0 {
            return 0.0;
        }
        lost / (length * duration)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::Shape;

    /// The edges of a ridge are straight, on a profile too: the formula is 4e-4 short of them. That of an ellipse of
    /// semi-axes 60 and 15 is 257.35 long, which its pixels know to a few per cent.
    #[test]
    fn ridges_and_ellipses() {
        let length = |[nx, ny]: [usize; 2], touches: &dyn Fn(f64, f64) -> bool| {
            let grid = Grid::new([nx, ny], [nx as f64, 0.5 * ny as f64]);
            let touches: Vec<bool> = (0..grid.len())
                .map(|i| touches((i % nx) as f64, 0.5 * (i / nx) as f64))
                .collect();
            let share = Share::whole(Shape::whole(nx, ny));
            let edge = Edge::new(&touches, &share, &grid, Boundary::Periodic);
            edge.expect("one process").length
        };
        let near = |found: f64, expected: f64, share: f64| {
            assert!((found / expected - 1.0).abs() < share, "{found} {expected}");
        };
        near(length([50, 1], &|x, _| x < 20.0), 2.0 * 0.5, 5e-4);
        near(length([50, 8], &|x, _| x < 20.0), 2.0 * 4.0, 5e-4);
        near(length([8, 50], &|_, y| y < 10.0), 2.0 * 8.0, 5e-4);
        let ellipse = |x: f64, y: f64| ((x - 69.5) / 60.0).hypot((y - 24.75) / 15.0) < 1.0;
        near(length([140, 100], &ellipse), 257.4, 0.02);
    }

    /// A disc of 40 pixels that shrinks by 4 within 2 s; its pixels know the radius to a fraction of one.
    #[test]
    fn a_shrinking_disc() {
        let grid = Grid::new([100, 90], [1.0, 0.9]);
        let disc = |radius: f64| -> Vec<bool> {
            (0..grid.len())
                .map(|i| {
                    let (x, y) = ((i % 100) as f64 - 49.5, (i / 100) as f64 - 44.5);
                    x.hypot(y) < radius
                })
                .collect()
        };
        let share = Share::whole(Shape::whole(100, 90));
        let [large, small] = [40.0, 36.0].map(|radius| {
            Edge::new(&disc(radius), &share, &grid, Boundary::Free).expect("one process")
        });
        assert!((large.length / (0.8 * std::f64::consts::PI) - 1.0).abs() < 0.02);
        let speed = large.recession(&small, 2.0);
        assert!((speed / 0.02 - 1.0).abs() < 0.03, "{speed}");
        assert_eq!(small.recession(&large, 2.0), 0.0);
        let [all, none] = [true, false].map(|touches| {
            let touches = vec![touches; grid.len()];
            Edge::new(&touches, &share, &grid, Boundary::Periodic).expect("one process")
        });
        assert_eq!(all.recession(&none, 2.0), 0.0);
    }
}
