//! `boundary = "free"`: one isolated contact on an unbounded half-space. The problem contains it; no step
//! of a path has to do anything for it.

use crate::grid::Boundary;
use crate::scene::Scene;
use crate::study::{Hooks, Plan};

/// One isolated contact on an unbounded half-space.
pub(super) struct FreeBoundary;

impl Hooks for FreeBoundary {
    fn name(&self) -> &'static str {
        "free boundary"
    }

    fn purpose(&self) -> &'static str {
        "one isolated contact on an unbounded half-space, on twice the points each way"
    }

    fn is_on(&self, scene: &Scene) -> bool {
        scene.grid.boundary == Boundary::Free
    }

    fn remove_from(&self, scene: &mut Scene) {
        scene.grid.boundary = Boundary::Periodic;
    }

    fn example(&self) -> &'static [(&'static str, &'static str)] {
        &[("grid.boundary", "free")]
    }

    fn matters(&self, _: &Plan) -> String {
        "matters where the contact is more than about a fifth of the cell: its images would press on it"
            .to_owned()
    }
}
