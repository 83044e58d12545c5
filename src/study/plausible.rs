//! Quantities beyond what solids and instruments have, with the slip of units that makes them.

use super::plan::Plan;
#[cfg(feature = "cli")]
use crate::grid::Grid;
use crate::scene::Control;
use crate::units::format_si;

/// Largest side of a map, m.
const SIDE: f64 = 10.0;
/// Radius of a tip on a cantilever, m, which no probe comes near to.
const TIP: f64 = 1.0;
/// Least contact modulus, Pa: the softest gels have tens.
const MODULUS: f64 = 1.0;
/// Least of the greatest mean pressures that paths have, Pa: the weight of a tenth of a millimetre of water.
const LOAD: f64 = 1.0;
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
        .top
        .sphere_radius()
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
    // Values in between may be 0 but for rounding.
    let loads = scene.loading.path.iter().map(|load| load.abs());
    let load = loads.fold(0.0, f64::max);
    let is_pressure = scene.loading.control == Control::Pressure;
    if is_pressure && load > 0.0 && load < LOAD && modulus >= MODULUS && side < REDUCED {
        found.push(format!(
            "the greatest mean pressure of the path is {}: was it meant in MPa?",
            format_si(load, "Pa")
        ));
    }
    found.extend(of_side(side));
    if let Some(radius) = tip.filter(|radius| *radius >= TIP) {
        found.push(format!(
            "a radius of {} at the tip of a cantilever: was it meant in um or nm?",
            format_si(radius, "m")
        ));
    }
    found.extend(of_slope(slope));
    found
}

/// The same of a surface alone.
#[cfg(feature = "cli")]
pub(crate) fn of_surface(grid: &Grid, rms_slope: f64) -> Vec<String> {
    let found = [of_side(grid.lx.max(grid.ly)), of_slope(rms_slope)];
    found.into_iter().flatten().collect()
}

fn of_side(side: f64) -> Option<String> {
    (side > SIDE).then(|| {
        format!(
            "a map {} wide is no surface that touches: was the size meant in um or nm?",
            format_si(side, "m")
        )
    })
}

fn of_slope(slope: f64) -> Option<String> {
    (slope > SLOPE).then(|| {
        // Of heights in nm it is a thousand million times too large.
        let shown = if slope < 1e4 {
            format!("{slope:.3}")
        } else {
            format!("{slope:.2e}")
        };
        format!(
            "an rms slope of {shown}, {:.0} degrees, is steeper than surfaces are: were the heights meant in another unit than the size?",
            slope.atan().to_degrees()
        )
    })
}
