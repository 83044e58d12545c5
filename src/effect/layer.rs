//! `thickness` in `[solid]`: an elastic layer on a rigid base in place of the half-space.

use crate::scene::Scene;
use crate::solver::Problem;
use crate::study::{Hooks, Plan, Setup, State, StepRow};
use crate::units::format_si;

/// Share of its thickness by which a layer is pressed together that is said: strains are no longer small.
const DEEP: f64 = 0.2;

/// A layer in place of the half-space.
pub(super) struct LayerEffect;

impl Hooks for LayerEffect {
    fn name(&self) -> &'static str {
        "layer"
    }

    fn purpose(&self) -> &'static str {
        "the solid is a layer on a rigid base, stiffer than the half-space to waves longer than its thickness"
    }

    fn is_on(&self, scene: &Scene) -> bool {
        scene.solid.layer.is_some()
    }

    fn remove_from(&self, scene: &mut Scene) {
        scene.solid.layer = None;
    }

    fn example(&self) -> &'static [(&'static str, &'static str)] {
        &[("solid.poisson_ratio", "0.3"), ("solid.thickness", "0.2")]
    }

    fn matters(&self, plan: &Plan) -> String {
        let grid = plan.outline.grid;
        let [x, y] = grid.varying(grid.size());
        let longest = x.max(y);
        let stiffer = plan.scene.solid.layer.map_or(1.0, |layer| {
            1.0 / layer.compliance(2.0 * std::f64::consts::PI / longest)
        });
        format!(
            "matters where contacts are as wide as it is thick: here the longest wave of the cell meets {stiffer:.3} times the half-space's stiffness"
        )
    }

    fn warning_of_step(&self, setup: &Setup, row: &StepRow) -> Option<[String; 2]> {
        let thickness = setup.scene.solid.layer?.thickness;
        let share = row.approach? / thickness;
        (row.state == State::Contact && share > DEEP).then(|| {
            [
                format!(
                    "the layer is pressed together by {}, {share:.2} of its thickness",
                    format_si(row.approach.unwrap_or_default(), "m")
                ),
                "; linear elasticity holds where that is a small part of it".to_owned(),
            ]
        })
    }

    fn pose(&self, problem: Problem, scene: &Scene, _: Option<&[f64]>) -> Problem {
        match scene.solid.layer {
            Some(layer) => problem.on_layer(layer),
            None => problem,
        }
    }
}
