//! `[friction]`: a shear strength times the area in contact.

use crate::scene::Scene;
use crate::study::{Column, Evaluation, Hooks, Plan, Setup};

/// Friction force of the shear strength over the area in contact, N.
const FORCE: Column = Column::new("friction_force", "N", 0);

/// Friction of the area in contact.
pub(super) struct Friction;

impl Hooks for Friction {
    fn name(&self) -> &'static str {
        "friction"
    }

    fn purpose(&self) -> &'static str {
        "a shear strength times the area in contact, in a column of its own; it changes nothing else"
    }

    fn is_on(&self, scene: &Scene) -> bool {
        scene.tables.friction.is_some()
    }

    fn remove_from(&self, scene: &mut Scene) {
        scene.tables.friction = None;
    }

    fn example(&self) -> &'static [(&'static str, &'static str)] {
        &[("friction", "{ shear_strength = 0.1 }")]
    }

    fn matters(&self, plan: &Plan) -> String {
        let friction = plan.scene.tables.friction;
        let strength = friction.map_or(0.0, |friction| friction.shear_strength);
        format!(
            "holds while sliding does not peel the contact: a shear strength well below the contact modulus, here {:.2e} of it",
            strength / plan.scene.solid.contact_modulus
        )
    }

    fn columns(&self) -> &'static [Column] {
        &[FORCE]
    }

    fn values(&self, setup: &Setup, evaluation: Option<&Evaluation>) -> Vec<(Column, f64)> {
        let area = setup.surface.grid.area();
        let friction = setup.scene.tables.friction.map(|friction| {
            let touching = evaluation.map(|e| e.contact_corrected.unwrap_or(e.contact));
            (
                FORCE,
                friction.shear_strength * touching.unwrap_or(0.0) * area,
            )
        });
        friction.into_iter().collect()
    }
}
