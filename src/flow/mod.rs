//! A thin film of fluid between the surfaces: whether the gap percolates, its critical constriction, and the flow.
//!
//! The flow through a gap u under a gradient of pressure p is u^3 grad p/(12 eta) (Reynolds 1886), and none
//! passes where the gap is closed. Fluid passes between points that share a side.

mod clusters;
mod faces;
mod graph;
mod layout;
mod levels;
mod multigrid;
mod percolation;
mod reynolds;

use rayon::prelude::*;

use crate::backend::{BackendError, Shape, Share};
use crate::grid::{Boundary, Grid};
use crate::scene::Axis;

use faces::Frame;

/// Where a fluid may flow.
#[derive(Clone, Copy, Debug)]
pub struct Film {
    /// Where the points lie.
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

impl Film {
    /// Finds the critical constriction, and the flow to a relative `tolerance` in at most `max_iterations`, through a gap, m,
    /// shape `[ny, nx]`; a point that is not above 0 is closed.
    pub fn flow(&self, gap: Vec<f64>, tolerance: f64, max_iterations: usize) -> Flow {
        let share = Share::whole(Shape::whole(self.grid.nx, self.grid.ny));
        let found = self.flow_on(&share, gap, tolerance, max_iterations, &mut |_, _| true);
        // One process waits for no other.
        found.unwrap_or(Flow {
            critical_gap: f64::NAN,
            permeance: f64::NAN,
            converged: false,
            iterations: 0,
        })
    }

    /// The same through a gap of which this process holds the rows of a share of the grid. The result has the same bits on
    /// every rank and on any number of them. `watch` sees each iteration with the relative error of the permeance, and says whether to go
    /// on.
    ///
    /// # Errors
    /// A rank has ended.
    #[doc(hidden)]
    pub fn flow_on(
        &self,
        share: &Share,
        mut gap: Vec<f64>,
        tolerance: f64,
        max_iterations: usize,
        watch: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Flow, BackendError> {
        debug_assert_eq!(share.shape().points, self.grid.points());
        let frame = Frame::new(&self.grid, self.boundary, self.axis);
        let unit = share.greatest(gap.iter().copied().fold(0.0, f64::max));
        share.failed()?;
        gap.par_iter_mut()
            .for_each(|gap| *gap = if *gap > 0.0 { *gap / unit } else { 0.0 });
        let critical_gap = percolation::close(share, &frame, &mut gap)?;
        if critical_gap <= 0.0 {
            return Ok(Flow {
                critical_gap: 0.0,
                permeance: 0.0,
                converged: true,
                iterations: 0,
            });
        }
        gap.par_iter_mut().for_each(|gap| *gap = gap.powi(3));
        let pressure = reynolds::solve(share, &frame, gap, tolerance, max_iterations, watch)?;
        Ok(Flow {
            critical_gap: critical_gap * unit,
            permeance: pressure.power * unit.powi(3),
            converged: pressure.converged,
            iterations: pressure.iterations,
        })
    }
}
