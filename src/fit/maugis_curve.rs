//! Force by approach of a Maugis-Dugdale sphere, tabulated once for a lambda.
//!
//! Maugis units (see [`crate::theory::tabor_map`]).

use std::f64::consts::{FRAC_PI_2, PI};

use crate::theory::TheoryError;
use crate::theory::maugis_dugdale::{FOLD_LAMBDA, MaugisDugdale};

/// States of the table; interpolated forces are accurate to 1e-7 of the pull-off.
const NODES: usize = 320;
/// Contact radius up to which the nodes are evenly spaced; beyond it the spacing grows.
const EVEN: f64 = 0.8;
/// Equal parts of the roots, each of which knows its first node.
const PARTS: usize = 1024;
/// Contact radius that represents the first touch.
const TOUCH: f64 = 1e-6;

/// The curve of one lambda.
#[derive(Clone, Debug)]
pub(super) struct MaugisCurve {
    model: MaugisDugdale,
    /// Square root of the approach beyond the first node: the force is smooth in it, also at a
    /// fold.
    roots: Vec<f64>,
    forces: Vec<f64>,
    /// For each of [`PARTS`] the first node that is not below it, and how many parts a root of 1 spans.
    nodes: Vec<usize>,
    parts: f64,
    /// For each four neighbouring nodes the cubic through them, by Newton's divided differences.
    cubics: Vec<[f64; 4]>,
    /// Approach of the first node: the fold, or the first touch.
    first: f64,
    /// Greatest tension.
    pub(super) pull_off: (f64, f64),
}

impl MaugisCurve {
    /// The curve at `lambda`, up to the approach `deepest`.
    pub(super) fn new(lambda: f64, deepest: f64) -> Result<Self, TheoryError> {
        let model = MaugisDugdale::new(lambda)?;
        let grip = model.grip()?;
        let folded = lambda > FOLD_LAMBDA;
        let begin = if folded { grip.contact_radius } else { TOUCH };
        // A^2 = approach + (4/3) lambda A t, and the tension indents no sphere by more than JKR.
        let end = 4.0 + deepest.max(0.0).sqrt();
        let stretch = ((end - begin) / EVEN).asinh();
        let mut roots = Vec::with_capacity(NODES);
        let mut forces = Vec::with_capacity(NODES);
        let state = model.state(begin)?;
        let first = state.approach;
        let mut zone = state.zone();
        for i in 0..NODES {
            let share = i as f64 / (NODES - 1) as f64;
            let state;
            (state, zone) = model.state_near(begin + EVEN * (share * stretch).sinh(), zone)?;
            let root = (state.approach - first).max(0.0).sqrt();
            // Rounding near the fold.
            if roots.last().is_none_or(|last| root > *last) {
                roots.push(root);
                forces.push(state.force);
            }
        }
        let pull_off = model.pull_off()?;
        let cubics = roots
            .windows(4)
            .zip(forces.windows(4))
            .map(|(x, y)| divided_differences(x, y))
            .collect();
        let parts = PARTS as f64 / roots.last().copied().unwrap_or(1.0);
        let below = |part: usize| roots.partition_point(|node| ((node * parts) as usize) < part);
        Ok(MaugisCurve {
            model,
            nodes: (0..=PARTS).map(below).collect(),
            parts,
            roots,
            forces,
            cubics,
            first,
            pull_off: (pull_off.approach, pull_off.force),
        })
    }

    /// Approach at which the surfaces jump apart: the fold of the contact, or of the open discs where the contact has none.
    pub(super) fn fold(&self) -> f64 {
        if self.model.lambda() > FOLD_LAMBDA {
            return self.first;
        }
        let centre = self.fold_of_discs();
        -self.model.range() - 0.5 * centre * centre
    }

    /// Radius of the open disc that lets go.
    fn fold_of_discs(&self) -> f64 {
        8.0 / (3.0 * PI) * self.model.lambda()
    }

    /// Force along the curve from the open disc to the contact; beyond its fold that of the fold.
    pub(super) fn force(&self, approach: f64) -> f64 {
        if approach >= self.first {
            return self.interpolated((approach - self.first).sqrt());
        }
        if self.model.lambda() > FOLD_LAMBDA {
            return self.forces[0];
        }
        // The stable one of the open discs.
        let centre = self.fold_of_discs();
        let square = centre * centre + 2.0 * (self.model.range() + approach);
        let radius = (centre + square.max(0.0).sqrt()).min(self.model.touching_radius());
        -FRAC_PI_2 * self.model.lambda() * radius * radius
    }

    /// The cubic through the four nodes around a place.
    fn interpolated(&self, root: f64) -> f64 {
        // Nodes of a lesser part are lower than the root.
        let mut after = self.nodes[((root * self.parts) as usize).min(PARTS)];
        while self.roots.get(after).is_some_and(|node| *node <= root) {
            after += 1;
        }
        let from = after.saturating_sub(2).min(self.cubics.len() - 1);
        let (x, c) = (&self.roots[from..from + 3], &self.cubics[from]);
        c[0] + (root - x[0]) * (c[1] + (root - x[1]) * (c[2] + (root - x[2]) * c[3]))
    }
}

/// Newton's coefficients of the cubic through four points.
fn divided_differences(x: &[f64], y: &[f64]) -> [f64; 4] {
    let mut c = [y[0], y[1], y[2], y[3]];
    for order in 1..4 {
        for i in (order..4).rev() {
            c[i] = (c[i] - c[i - 1]) / (x[i] - x[i - order]);
        }
    }
    c
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_the_curve() {
        for lambda in [0.02, 0.3, 0.9, 0.95, 2.0, 15.0] {
            let curve = MaugisCurve::new(lambda, 50.0).unwrap();
            let model = MaugisDugdale::new(lambda).unwrap();
            for approach in [-0.9, -0.6, -0.3, 0.0, 1.0, 7.0, 49.0] {
                let Some(state) = model.states_at_approach(approach).unwrap().pop() else {
                    continue;
                };
                let got = curve.force(approach);
                assert!(
                    (got - state.force).abs() < 1e-6 * (1.0 + state.force.abs()),
                    "{lambda} {approach}: {got} {}",
                    state.force
                );
            }
        }
    }
}
