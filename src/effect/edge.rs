//! The edge of a contact: how long it is, and how fast it recedes.

use std::f64::consts::FRAC_PI_4;

use crate::backend::{BackendError, Share};
use crate::grid::{Boundary, Grid};

/// Area in contact and the length of its edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    /// Area, m^2.
    pub area: f64,
    /// Length of the edge, m.
    pub length: f64,
}

impl Edge {
    /// The edge of the points of a grid that touch.
    ///
    /// The staircase of pixels is 4/pi times as long as an isotropic edge.
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
        let [staircase] = share.sums(rows.len(), |row, [staircase]| {
            let (here, next) = (line(row), line(row + 1));
            let is_followed = rows.start + row + 1 < ny || wraps;
            for x in 0..nx {
                if (x + 1 < nx || wraps) && here[x] != here[(x + 1) % nx] {
                    *staircase += grid.dy();
                }
                if is_followed && here[x] != next[x] {
                    *staircase += grid.dx();
                }
            }
        });
        let [count] = share.counts([touches.iter().filter(|&&touches| touches > 0).count()]);
        Ok(Edge {
            area: count as f64 * grid.pixel_area(),
            length: FRAC_PI_4 * staircase,
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
