//! `map` in `[adhesion]`: a factor on the law's tension at each point.

use crate::scene::{self, Scene};
use crate::solver::Problem;
use crate::study::{DOUBLE, Hooks, HostBytes, Plan, Sizes};

/// Share of a half period by which the pixels may widen or narrow it.
const UNEVEN: f64 = 0.05;

/// A tension that differs from point to point.
pub(super) struct AdhesionMap;

impl Hooks for AdhesionMap {
    fn name(&self) -> &'static str {
        "adhesion map"
    }

    fn purpose(&self) -> &'static str {
        "a factor of its own multiplies the tension at each point"
    }

    fn is_on(&self, scene: &Scene) -> bool {
        let adhesion = scene.adhesion.as_ref();
        adhesion.is_some_and(|adhesion| adhesion.map.is_some())
    }

    fn remove_from(&self, scene: &mut Scene) {
        if let Some(adhesion) = &mut scene.adhesion {
            adhesion.map = None;
        }
    }

    fn example(&self) -> &'static [(&'static str, &'static str)] {
        &[
            super::adhesion::EXAMPLE,
            (
                "adhesion.map",
                "{ pattern = \"checker\", period = 0.5, low = 0.2, high = 1.5 }",
            ),
        ]
    }

    fn matters(&self, plan: &Plan) -> String {
        let map = plan.outline.map;
        let (mean, deviation) = map.map_or((1.0, 0.0), |map| (map.mean, map.deviation));
        format!(
            "matters where it varies over lengths of the contacts: here the factor is {mean:.3} on average, give or take {deviation:.3}"
        )
    }

    fn warnings(&self, plan: &Plan) -> Vec<String> {
        let adhesion = plan.scene.adhesion.as_ref();
        let Some(scene::AdhesionMap::Pattern { kind, period, .. }) =
            adhesion.and_then(|adhesion| adhesion.map.as_ref())
        else {
            return Vec::new();
        };
        let grid = plan.outline.grid;
        let across = match kind {
            scene::PatternKind::Stripe => 1,
            scene::PatternKind::Checker => 2,
        };
        let halves = [grid.dx(), grid.dy()].map(|pixel| 0.5 * period / pixel);
        let uneven = |half: &&f64| (half.round() - **half).abs() > UNEVEN * **half;
        let Some(half) = halves[..across].iter().find(uneven) else {
            return Vec::new();
        };
        let mean = plan.outline.map.map_or(1.0, |map| map.mean);
        vec![format!(
            "half a period of the pattern of adhesion.map is {half:.2} pixels, which the grid makes {} or {}: the mean factor is {mean:.3}; take points of which half a period holds a whole number, or more points",
            half.floor(),
            half.ceil(),
        )]
    }

    fn host_bytes(&self, sizes: &Sizes) -> HostBytes {
        HostBytes {
            // The factors of the surface, of the problem and of the watch for jumps.
            kept: 3 * DOUBLE * sizes.points,
            ..HostBytes::default()
        }
    }

    fn pose(&self, problem: Problem, _: &Scene, map: Option<&[f64]>) -> Problem {
        // A problem without a law has no tension to multiply.
        if problem.law.is_adhesive() {
            problem.with_adhesion_map(map.unwrap_or_default().to_vec())
        } else {
            problem
        }
    }
}
