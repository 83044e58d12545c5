//! `spring` in `[loading]`: the approach acts through a cantilever.

use crate::scene::Scene;
use crate::study::{Hooks, Plan};

/// A spring between the prescribed approach and the body.
pub(super) struct Spring;

impl Hooks for Spring {
    fn name(&self) -> &'static str {
        "spring"
    }

    fn purpose(&self) -> &'static str {
        "the approach is prescribed at the far end of a spring, so contacts snap in and off"
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
        let stiffness = plan.scene.loading.spring.unwrap_or(0.0);
        let contact = 2.0 * plan.scene.solid.contact_modulus * plan.outline.grid.area().sqrt();
        format!(
            "snaps where the spring is softer than the attraction's gradient: here it has {:.2e} of the stiffness of a punch as wide as the grid",
            stiffness / contact
        )
    }

    fn spring(&self, scene: &Scene) -> Option<f64> {
        scene.loading.spring
    }
}
