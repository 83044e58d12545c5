//! The edges of a free grid at which a surface is cut off that goes on behind them.

use std::iter::StepBy;
use std::ops::Range;

use super::evaluation::PointState;
use super::observer::FinishedStep;
use crate::backend::Share;
use crate::grid::{Boundary, Grid};
use crate::surface::Surface;

/// Share of the range of heights by which an edge lies below the mean: more than rounding.
const BELOW: f64 = 1e-6;

/// Which edges of the grid cut the surface off: the columns at both ends, the first row and the last.
///
/// An edge cuts the surface off if its highest point is below the mean of the heights in the middle of the grid: a tip continues
/// beyond it, and contact at the edge lacks the part outside the grid. A flat, a punch and a rough patch end at their edges, as a
/// ridge does at its ends, and may touch there. A single sphere is cut off at every edge except one with its apex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CutEdges([bool; 4]);

impl CutEdges {
    /// The cut edges of a surface, of which this process holds some rows.
    pub fn from_surface(surface: &Surface, share: &Share, boundary: Boundary) -> CutEdges {
        if boundary == Boundary::Periodic {
            return CutEdges([false; 4]);
        }
        let heights = surface.heights.as_slice();
        let (lowest, highest) = (share.least_of(heights), share.greatest_of(heights));
        let mean = match surface.top.sphere_radius() {
            Some(_) => highest,
            None => highest + mean_in_the_middle(heights, highest, &surface.grid, share),
        };
        let level = mean - BELOW * (highest - lowest);
        CutEdges(edges(share).map(|edge| {
            let here = edge.map(|i| heights[i]).fold(f64::NEG_INFINITY, f64::max);
            share.greatest(here) < level
        }))
    }

    /// Points in contact, and points attracted, at these edges in the rows that this process holds.
    pub fn reached(self, points: &[PointState], share: &Share) -> [usize; 2] {
        let cut = edges(share).into_iter().zip(self.0);
        let cut = cut.filter_map(|(edge, is_cut)| is_cut.then_some(edge));
        cut.flatten()
            .fold([0; 2], |[contact, attracted], i| match points[i] {
                PointState::Contact => [contact + 1, attracted],
                PointState::Attracted => [contact, attracted + 1],
                PointState::Separated => [contact, attracted],
            })
    }
}

/// Mean of the heights over the square in the middle of the grid that is as wide as this is one way, less `from`.
fn mean_in_the_middle(heights: &[f64], from: f64, grid: &Grid, share: &Share) -> f64 {
    let side = grid.lx.min(grid.ly);
    let middle = |points: usize, pixel: f64| {
        let within = ((side / pixel).round() as usize).clamp(1, points);
        let first = (points - within) / 2;
        first..first + within
    };
    let (columns, among) = (middle(grid.nx, grid.dx()), middle(grid.ny, grid.dy()));
    let rows = share.surface_rows();
    let [sum, count] = share.sums(rows.len(), |row, [sum, count]| {
        if among.contains(&(rows.start + row)) {
            for height in &heights[row * grid.nx..][columns.clone()] {
                *sum += height - from;
                *count += 1.0;
            }
        }
    });
    sum / count
}

/// The points of each edge among the rows that this process holds.
fn edges(share: &Share) -> [StepBy<Range<usize>>; 4] {
    let [nx, ny] = share.surface();
    let rows = share.surface_rows();
    let held = rows.len() * nx;
    let row = |is_held: bool, at: usize| if is_held { at..at + nx } else { 0..0 };
    let some = held > 0;
    [
        (0..held).step_by(nx),
        ((nx - 1).min(held)..held).step_by(nx),
        row(some && rows.start == 0, 0).step_by(1),
        row(some && rows.end == ny, held.saturating_sub(nx)).step_by(1),
    ]
}

/// What is said of contact, and of attraction, at a cut edge.
const CONTACT: &str = "the contact reaches the edge of the free grid, behind which the surface goes on but is not there: forces and areas are those of the cut surface; take a larger grid.size with more points, or a larger map";
const ATTRACTION: &str = "the attraction reaches the edge of the free grid, and what would act behind it is missing in the force; take a larger grid.size with more points, or a larger map";

/// The warning of a step that reaches an edge where the surface is cut off, unless those `said` have it or a stronger one.
pub(super) fn edge_warning(step: &FinishedStep, said: &[String]) -> Option<&'static str> {
    let (words, at_least): (_, &[&str]) = match step.evaluation.as_ref()?.at_cut_edge? {
        PointState::Contact => (CONTACT, &[CONTACT]),
        _ => (ATTRACTION, &[CONTACT, ATTRACTION]),
    };
    let known = |text: &String| at_least.iter().any(|words| text.ends_with(words));
    (!said.iter().any(known)).then_some(words)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backend::Shape;
    use crate::surface::Top;

    fn cut([nx, ny]: [usize; 2], sphere: bool, height: impl Fn(f64, f64) -> f64) -> [bool; 4] {
        let [x0, y0] = [nx, ny].map(|points| 0.5 * (points - 1) as f64);
        let heights: Vec<f64> = (0..nx * ny)
            .map(|i| height((i % nx) as f64 - x0, (i / nx) as f64 - y0))
            .collect();
        let surface = Surface {
            grid: Grid::new([nx, ny], [nx as f64, ny as f64]),
            heights: heights.into(),
            highest: 0.0,
            top: if sphere {
                Top::Sphere(1.0)
            } else {
                Top::Unknown
            },
            adhesion_map: None,
            warnings: Vec::new(),
        };
        let share = Share::whole(Shape::whole(nx, ny));
        CutEdges::from_surface(&surface, &share, Boundary::Free).0
    }

    #[test]
    fn edges_cut_a_cap_and_a_ridge_but_no_flat_and_no_rough_patch() {
        for points in [[9, 7], [15, 15], [31, 9]] {
            let cut = |height: fn(f64, f64) -> f64| cut(points, false, height);
            assert_eq!(cut(|x, y| -x * x - y * y), [true; 4], "{points:?}");
            assert_eq!(cut(|x, y| -x.hypot(y)), [true; 4], "{points:?}");
            assert_eq!(cut(|x, _| -x * x), [true, true, false, false]);
            assert_eq!(cut(|_, _| 0.1), [false; 4]);
            let rough = |x: f64, y: f64| (437.0 * (12.9 * x + 78.2 * y).sin()).fract();
            assert_eq!(cut(rough), [false; 4], "{points:?}");
            // A flat punch on its ground.
            let punch = |x: f64, y: f64| f64::from(u8::from(x.abs() < 2.0 && y.abs() < 2.0));
            assert_eq!(cut(punch), [true; 4], "{points:?}");
        }
        // One sphere, whose apex is near an edge or on it.
        let cut = |x0: f64| cut([9, 9], true, move |x, y| -(x - x0).powi(2) - y * y);
        assert_eq!(cut(-3.0), [true; 4]);
        assert_eq!(cut(-4.0), [false, true, true, true]);
    }

    #[test]
    fn points_at_cut_edges_are_counted() {
        let share = Share::whole(Shape::whole(4, 3));
        let mut points = vec![PointState::Separated; 12];
        (points[5], points[7], points[8]) = (
            PointState::Contact,
            PointState::Contact,
            PointState::Attracted,
        );
        let reached = |cut| CutEdges(cut).reached(&points, &share);
        assert_eq!(reached([true, false, false, false]), [0, 1]);
        assert_eq!(reached([false, true, false, false]), [1, 0]);
        assert_eq!(reached([false, false, true, false]), [0, 0]);
        assert_eq!(reached([false, false, false, true]), [0, 1]);
    }
}
