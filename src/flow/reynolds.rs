//! The flow through the points that conduct: finite volumes, one a point.
//!
//! The pressure falls by 1 along the grid. What enters a point leaves it: the sum over its faces of conductance times
//! difference of pressure is 0. The permeance is the power that is lost, the sum over all faces of conductance times the
//! square of the difference; an error of the pressure enters it by its square.

use super::faces::{Faces, Frame, rows_beside};
use super::layout::{Halo, Layout};
use super::levels::{Level, Strip};
use super::multigrid::{self, Pressure};
use crate::backend::{BackendError, Share};

/// Rows of a strip: ranks hold whole blocks of as many.
const STRIP: usize = 8;

/// Solves for the pressure on the held rows of points that conduct, from the cubes of their gaps. The power is the permeance.
/// `watch` is that of [`multigrid::solve`].
///
/// # Errors
/// A rank has ended.
pub(super) fn solve(
    share: &Share,
    frame: &Frame,
    cubes: Vec<f64>,
    tolerance: f64,
    max_iterations: usize,
    watch: &mut dyn FnMut(usize, f64) -> bool,
) -> Result<Pressure, BackendError> {
    let width = frame.points[0];
    let layout = Layout::of_rows(share, STRIP, frame.repeats);
    let rows = |strip: usize| {
        let nodes = layout.nodes_of(strip);
        [nodes.start / width, nodes.end / width]
    };
    let beside = layout.find(|strip| rows_beside(frame, rows(strip)));
    let halo = Halo::new(share, &layout, beside)?;
    let outside = halo.outside(share, &layout, &cubes, |_| true)?;
    let first = layout.own().start;
    let strips = layout.find(|strip| {
        let cubes = &cubes[layout.place(strip)];
        let [first_row, _] = rows(strip);
        Strip::Faces(Faces::new(frame, first_row, cubes, &outside[strip - first]))
    });
    drop(outside);
    let mut source = cubes;
    let parts = layout.parts(&mut source).into_iter();
    layout.for_each(parts.zip(&strips).collect(), |(source, strip)| {
        if let Strip::Faces(faces) = strip {
            faces.source(source);
        }
    });
    let graph = Level {
        layout,
        strips,
        halo,
    };
    let power = |graph: &Level, pressure: &[f64]| {
        let layout = &graph.layout;
        let outside = graph.outside(share, pressure)?;
        let lost = layout.find(|strip| match &graph.strips[strip - first] {
            Strip::Faces(faces) => {
                faces.power(&pressure[layout.place(strip)], &outside[strip - first])
            }
            Strip::Graph(_) => 0.0,
        });
        layout.sum(share, lost)
    };
    multigrid::solve(
        share,
        graph,
        source,
        power,
        tolerance,
        max_iterations,
        watch,
    )
}
