//! `spring` in `[loading]`: the approach acts through a cantilever.

use crate::scene::{Boundary, Scene};
use crate::study::{Hooks, Plan};
use crate::units::format_si;

/// Stiffness over that of a punch as wide as the grid from which on a spring gives nothing that its contact would show, and
/// on a periodic grid, whose mean displacement meets no other resistance, a step takes three to ten times the iterations.
/// At a million times some steps do not converge.
const RIGID: f64 = 2e3;

/// A spring between the prescribed approach and the body.
pub(super) struct Spring;

impl Hooks for Spring {
    fn name(&self) -> &'static str {
        "spring"
    }

    fn purpose(&self) -> &'static str {
        "the approach is prescribed at the far end of a spring"
    }

    fn is_on(&self, scene: &Scene) -> bool {
        scene.loading.spring.is_some()
    }

    fn remove_from(&self, scene: &mut Scene) {
        scene.loading.spring = None;
    }

    fn example(&self) -> &'static [(&'static str, &'static str)] {
        &[("loading.spring", "1.0")]
    }

    fn matters(&self, plan: &Plan) -> String {
        let what = if plan.law.is_adhesive() {
            "contacts snap in and off where the spring is softer than the attraction's gradient"
        } else {
            "gives as the contact does, and without adhesion no contact snaps"
        };
        format!(
            "{what}: here it has {:.2e} of the stiffness of a punch as wide as the grid",
            relative_stiffness(plan)
        )
    }

    fn warnings(&self, plan: &Plan) -> Vec<String> {
        let relative = relative_stiffness(plan);
        if relative < RIGID || plan.scene.grid.boundary != Boundary::Periodic {
            return Vec::new();
        }
        let stiffness = format_si(plan.scene.loading.spring.unwrap_or(0.0), "N/m");
        vec![format!(
            "a spring of {stiffness} is {relative:.1e} times as stiff as a punch as wide as the grid: it gives nothing, and steps take many times the iterations or do not converge; leave loading.spring out"
        )]
    }

    fn spring(&self, scene: &Scene) -> Option<f64> {
        scene.loading.spring
    }
}

/// Stiffness of the spring over that of a punch as wide as the grid, `2 E* a` of a round one with the radius a (Johnson 1985, sec. 3.4).
fn relative_stiffness(plan: &Plan) -> f64 {
    let stiffness = plan.scene.loading.spring.unwrap_or(0.0);
    let radius = 0.5 * plan.outline.grid.area().sqrt();
    stiffness / (2.0 * plan.scene.solid.contact_modulus * radius)
}
