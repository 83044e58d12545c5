//! Quantities beyond what solids and instruments have, with the slip of units that makes them.

use super::plan::Plan;
use crate::units::format_si;

/// Largest side of a map, m.
const SIDE: f64 = 10.0;
/// Radius of a tip on a cantilever, m, which no probe comes near to.
const TIP: f64 = 1.0;
/// Least contact modulus, Pa: the softest gels have tens.
const MODULUS: f64 = 1.0;
/// Side of a map, m, from which on a scene is in reduced units, in which a modulus is about 1.
const REDUCED: f64 = 0.01;
/// Largest rms slope: steeper than 84 degrees.
const SLOPE: f64 = 10.0;

/// A warning of each implausible quantity.
pub(super) fn warnings(plan: &Plan) -> Vec<String> {
    let scene = &plan.scene;
    let grid = plan.outline.grid;
    let side = grid.lx.max(grid.ly);
    let tip = plan
        .outline
        .sphere_radius
        .filter(|_| plan.effects.spring(scene).is_some());
    let slope = plan.outline.moments.rms_slope();
    let modulus = scene.solid.contact_modulus;
    let mut found = Vec::new();
    if modulus < MODULUS && side < REDUCED {
        found.push(format!(
            "a contact modulus of {} is less than solids have: was it meant in MPa or GPa?",
            format_si(modulus, "Pa")
        ));
    }
    if side > SIDE {
        found.push(format!(
            "a map {} wide is no surface that touches: was the size meant in um or nm?",
            format_si(side, "m")
        ));
    }
    if let Some(radius) = tip.filter(|radius| *radius >= TIP) {
        found.push(format!(
            "a radius of {} at the tip of a cantilever: was it meant in um or nm?",
            format_si(radius, "m")
        ));
    }
    if slope > SLOPE {
        // Of heights in nm it is a thousand million times too large.
        let shown = if slope < 1e4 {
            format!("{slope:.3}")
        } else {
            format!("{slope:.2e}")
        };
        found.push(format!(
            "an rms slope of {shown}, {:.0} degrees, is steeper than surfaces are: were the heights meant in another unit than the size?",
            slope.atan().to_degrees()
        ));
    }
    found
}
