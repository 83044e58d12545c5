//! A solved load as arrays.

use std::borrow::Cow;

use crate::scene::FieldName;
use crate::shared_values::SharedValues;
use crate::study::{Evaluation, Jump, PullOff, Setup, State, StepRow, Unreachable};

/// A solved load, SI. Arrays have shape `[ny, nx]`, row-major: point (ix, iy) is element `iy * nx + ix`.
///
/// A load without equilibrium leaves the surfaces separated: then [`approach`](Solution::approach) is
/// `None`, the gap is infinite, the pressure 0, and the displacement 0 (NaN on a viscoelastic solid, whose
/// past still moves it). One that no contact can have, as a position beyond full contact, has not converged:
/// [`unreachable`](Solution::unreachable) says why, and these fields are NaN.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Solution {
    /// Points along x and y: arrays hold `points[1]` rows of `points[0]`.
    pub points: [usize; 2],
    /// Lengths along x and y, m.
    pub size: [f64; 2],
    /// Distance between the surfaces, m; 0 in contact, and negative only inside the core of Lennard-Jones.
    pub gap: Vec<f64>,
    /// Net normal traction, Pa, positive in compression.
    pub pressure: Vec<f64>,
    /// Normal displacement of the solid's surface, m, positive into it.
    pub displacement: Vec<f64>,
    /// Heights, m, with the plastic depth subtracted; those given where the surfaces are separated. Without hardness all
    /// solutions of a path share them.
    pub heights: SharedValues,
    /// Share of the points that are in contact.
    pub contact_area_fraction: f64,
    /// Force, N, positive in compression.
    pub force: f64,
    /// Force over the area of the grid, Pa.
    pub mean_pressure: f64,
    /// Rigid displacement of the bodies towards each other since they first touched, m.
    pub approach: Option<f64>,
    /// Mean of the gap over the grid, m.
    pub mean_gap: Option<f64>,
    /// Residual, compared with the tolerance; defined in `docs/solver.md`.
    pub residual: f64,
    /// Iterations of the solver.
    pub iterations: usize,
    /// Whether the residual meets the tolerance. The fields of a load that did not converge are those of its
    /// last iteration, and a path ends there.
    pub converged: bool,
    /// Why it has not converged, where its iterations are not the reason.
    pub unreachable: Option<Unreachable>,
    /// Whether something touches, attracts, or nothing of both.
    pub state: State,
    /// The jump between this load and the one before, if there was one.
    pub jump: Option<Jump>,
    /// The tensions, N, between which the contact let go under a prescribed load or off a spring, where it did on the path up to
    /// here: the greatest that held and the least that did not, or that the spring could not pass. `Contact::pull_off_tolerance` says how close they are.
    pub pull_off: Option<[f64; 2]>,
    /// The row of `curve.csv`: energies, areas, and what effects add.
    pub row: StepRow,
}

impl Solution {
    /// A finished step; `evaluation` is missing where the surfaces are separated.
    pub(super) fn new(
        setup: &Setup,
        row: StepRow,
        evaluation: Option<Evaluation>,
        jump: Option<Jump>,
        pull_off: Option<PullOff>,
        unreachable: Option<Unreachable>,
    ) -> Self {
        let grid = setup.surface.grid;
        let heights = &setup.surface.heights;
        let (gap, pressure, displacement, heights) = match evaluation {
            Some(found) => {
                let displacement = found.field(FieldName::Displacement, heights).into_owned();
                let heights = match found.field(FieldName::Heights, heights) {
                    Cow::Borrowed(_) => heights.clone(),
                    Cow::Owned(lowered) => lowered.into(),
                };
                (
                    found.gap.into(),
                    found.pressure.into(),
                    displacement,
                    heights,
                )
            }
            None => {
                let is_known = !unreachable.is_some_and(Unreachable::is_without_state);
                let [gap, pressure, displacement] = match setup.scene.solid.relaxation.is_empty() {
                    _ if !is_known => [f64::NAN; 3],
                    true => [f64::INFINITY, 0.0, 0.0],
                    false => [f64::INFINITY, 0.0, f64::NAN],
                };
                let all = |value: f64| vec![value; grid.len()];
                (all(gap), all(pressure), all(displacement), heights.clone())
            }
        };
        Solution {
            points: grid.points(),
            size: grid.size(),
            gap,
            pressure,
            displacement,
            heights,
            contact_area_fraction: row.contact_area_fraction,
            force: row.force,
            mean_pressure: row.mean_pressure,
            approach: row.approach,
            mean_gap: row.mean_gap,
            residual: row.residual,
            iterations: row.iterations,
            converged: row.converged,
            unreachable,
            state: row.state,
            jump,
            pull_off: pull_off.map(|found| [found.lower, found.upper]),
            row,
        }
    }
}
