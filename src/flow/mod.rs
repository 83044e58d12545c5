//! A thin film of fluid between the surfaces: whether the gap percolates, its critical constriction, and the flow.
//!
//! The flow through a gap u under a gradient of pressure p is u^3 grad p/(12 eta) (Reynolds 1886), and none
//! passes where the gap is closed. Fluid passes between points that share a side.

mod lattice;
mod multigrid;
mod percolation;
mod reynolds;

use crate::grid::{Boundary, Grid};
use crate::scene::Axis;

use lattice::Lattice;

/// Most points of a grid: points are counted in four bytes, and the last number is no point.
pub const MOST_POINTS: usize = u32::MAX as usize - 1;

/// A gap that a fluid may fill.
#[derive(Clone, Copy, Debug)]
pub struct Film<'a> {
    /// Gap, m, shape `[ny, nx]`; a point that is not above 0 is closed.
    pub gap: &'a [f64],
    /// Where the points lie; at most [`MOST_POINTS`].
    pub grid: Grid,
    /// A periodic gap repeats in every cell, and the pressure falls by the same from one cell to the next. A free one
    /// has an inlet and an outlet at the two edges across the flow, and walls at the other two.
    pub boundary: Boundary,
    /// Where the fluid flows to.
    pub axis: Axis,
}

/// What flows through a gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flow {
    /// Critical constriction, m: the largest gap such that the points of at least this gap percolate; 0 where the open
    /// points do not.
    pub critical_gap: f64,
    /// Flow through the width of the grid over the fall of pressure along its length, times 12 viscosities, m^3.
    pub permeance: f64,
    /// Whether the permeance is known to the tolerance that was asked.
    pub converged: bool,
    /// Iterations.
    pub iterations: usize,
}

impl Film<'_> {
    /// Finds the critical constriction, and the flow to a relative `tolerance` in at most `max_iterations`.
    pub fn flow(&self, tolerance: f64, max_iterations: usize) -> Flow {
        let lattice = Lattice::new(self);
        let percolation = percolation::find(&lattice);
        if percolation.critical_gap <= 0.0 {
            return Flow {
                critical_gap: 0.0,
                permeance: 0.0,
                converged: true,
                iterations: 0,
            };
        }
        let solution =
            reynolds::solve(&lattice, &percolation.conducting, tolerance, max_iterations);
        let unit = lattice.largest_gap;
        Flow {
            critical_gap: percolation.critical_gap * unit,
            permeance: solution.permeance * unit.powi(3),
            converged: solution.converged,
            iterations: solution.iterations,
        }
    }
}

#[cfg(test)]
mod tests;
