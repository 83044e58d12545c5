//! The flow through the points that conduct: finite volumes, one a point.
//!
//! The pressure falls by 1 along the grid. What enters a point leaves it: the sum over its faces of conductance times
//! difference of pressure is 0. The permeance is the power that is lost, the sum over all faces of conductance times the
//! square of the difference; an error of the pressure enters it by its square.

use super::lattice::Lattice;
use super::multigrid::{Graph, Pressure};

/// No unknown.
const NONE: u32 = u32::MAX;

/// The flow through a gap.
pub(super) struct Solution {
    /// Over the cube of the largest gap.
    pub permeance: f64,
    /// Whether it is known to the tolerance.
    pub converged: bool,
    /// Iterations.
    pub iterations: usize,
}

/// Solves for the pressure on the points that conduct.
pub(super) fn solve(
    lattice: &Lattice,
    conducting: &[u32],
    tolerance: f64,
    max_iterations: usize,
) -> Solution {
    let mut unknown = vec![NONE; lattice.len()];
    for (number, point) in conducting.iter().enumerate() {
        unknown[*point as usize] = number as u32;
    }
    let conducts = |point: usize| unknown[point] != NONE;
    // In a repeating cell the pressure that is solved for is that of the first cell: the next one has 1 less.
    let mut source = Vec::with_capacity(conducting.len());
    let mut graph = Graph::with_capacity(conducting.len());
    for point in conducting.iter().map(|point| *point as usize) {
        let mut entering = 0.0;
        for link in lattice.links(point).filter(|link| conducts(link.to)) {
            let face = lattice.face(point, link);
            entering -= f64::from(link.cells) * face;
            // A cell of one point is its own neighbour.
            if link.to != point {
                graph.link(unknown[link.to], face);
            }
        }
        let [inlet, outlet] = lattice.ends(point);
        source.push(entering + inlet);
        graph.end_node(inlet + outlet);
    }
    let power = |pressure: &[f64]| {
        let faces = conducting.iter().zip(pressure).map(|(point, here)| {
            let point = *point as usize;
            let links = lattice.forward(point).filter(|link| conducts(link.to));
            let lost = links.map(|link| {
                let drop = here - pressure[unknown[link.to] as usize] + f64::from(link.cells);
                lattice.face(point, link) * drop * drop
            });
            let [inlet, outlet] = lattice.ends(point);
            lost.sum::<f64>() + inlet * (1.0 - here) * (1.0 - here) + outlet * here * here
        });
        faces.sum::<f64>()
    };
    let Pressure {
        power: permeance,
        converged,
        iterations,
    } = graph.solve(&source, power, tolerance, max_iterations);
    Solution {
        permeance,
        converged,
        iterations,
    }
}
