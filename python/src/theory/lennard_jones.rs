//! The elastic sphere with a Lennard-Jones law, whose equilibria are found numerically.

use std::f64::consts::PI;
use std::sync::{Mutex, PoisonError};

use tabor::theory::fuller_tabor::Path;
use tabor::theory::lennard_jones_sphere::{LennardJonesSphere, State};
use tabor::theory::tabor_map::tabor_parameter;
use tabor::theory::{Sphere, TheoryError};

/// What the names of its functions begin with.
pub const NAME: &str = "lennard_jones_sphere";

/// Approaches that a curve is made for, in ranges: its cost grows with them, and most are within the first one.
const DEPTHS: [f64; 3] = [2.0, 6.0, 20.0];

/// A sphere with its curve up to a depth.
struct Curve {
    depth: f64,
    sphere: LennardJonesSphere,
    states: Vec<State>,
    pull_off: State,
}

/// The curves of the last Tabor parameter, one a depth, which elements of a call and calls in turn share: one takes a fraction
/// of a second, or more. A deeper curve has other points, so that none stands for another: results are those of the arguments
/// alone.
static LAST: Mutex<Vec<Curve>> = Mutex::new(Vec::new());

/// The curve of a Tabor parameter up to an approach in ranges.
fn with_curve<R>(
    tabor_parameter: f64,
    approach: f64,
    use_it: impl FnOnce(&Curve) -> Result<R, TheoryError>,
) -> Result<R, TheoryError> {
    let least = DEPTHS.into_iter().find(|depth| approach <= *depth);
    let Some(least) = least else {
        return Err(TheoryError::OutOfRange {
            name: "approach",
            value: approach,
            allowed: "20 ranges or less; this one is in ranges",
        });
    };
    let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
    last.retain(|kept| kept.sphere.tabor_parameter().to_bits() == tabor_parameter.to_bits());
    let place = match last.iter().position(|kept| kept.depth == least) {
        Some(place) => place,
        None => {
            let sphere = LennardJonesSphere::new(tabor_parameter, least)?;
            last.push(Curve {
                depth: least,
                states: sphere.curve_to(least)?,
                pull_off: sphere.pull_off()?,
                sphere,
            });
            last.len() - 1
        }
    };
    use_it(&last[place])
}

/// Force, approach, contact radius and gap on the axis of a state.
fn si(
    found: &LennardJonesSphere,
    state: &State,
    sphere: &Sphere,
    range: f64,
) -> Result<Vec<f64>, TheoryError> {
    let centre = found.gap(state, 0.0);
    let radius = if centre < 0.0 {
        found.radius_of_gap(state, 0.0)?
    } else {
        0.0
    };
    Ok(vec![
        2.0 * PI * sphere.work_of_adhesion() * sphere.radius() * state.force,
        range * state.approach,
        (sphere.radius() * range).sqrt() * radius,
        range * centre,
    ])
}

/// Force, approach, contact radius and gap on the axis at an approach.
pub fn at_approach(
    sphere: &Sphere,
    range: f64,
    approach: f64,
    path: Path,
) -> Result<Vec<f64>, TheoryError> {
    let reduced = approach / range;
    with_curve(tabor_parameter(sphere, range)?, reduced, |curve| {
        let together = matches!(path, Path::Loading);
        let state = curve.sphere.on_curve(&curve.states, reduced, together)?;
        si(&curve.sphere, &state, sphere, range)
    })
}

/// The same at the greatest tension.
pub fn pull_off(sphere: &Sphere, range: f64) -> Result<Vec<f64>, TheoryError> {
    with_curve(tabor_parameter(sphere, range)?, 0.0, |curve| {
        si(&curve.sphere, &curve.pull_off, sphere, range)
    })
}
