//! Contacts whose curves are known in closed form: stiff spheres, and the limits that DMT and JKR are themselves.

use std::f64::consts::{PI, TAU};

use tabor::fit::Model;
use tabor::fit::model::{IndenterModel, Parameters};
use tabor::theory::{Sphere, TheoryError, hertz, jkr};

use super::problems::{Closed, Point, Problem};

/// States of each direction.
const STATES: usize = 600;
/// Share of the states before contact.
const FREE: f64 = 0.3;
/// Width of a jump, over the stretch at pull-off.
const JUMP: f64 = 1e-9;

/// Loading and unloading of a problem in closed form.
pub fn curve(problem: &Problem, closed: Closed) -> Result<Vec<Point>, TheoryError> {
    let sphere = Sphere::new(1.0, problem.modulus(), 1.0)?;
    let stretch = (PI / (4.0 / 3.0 * problem.modulus())).powf(2.0 / 3.0);
    let deepest = ((problem.load + 1.0) * TAU / (4.0 / 3.0 * problem.modulus())).powf(2.0 / 3.0);
    let (start, jump) = match closed {
        Closed::Stiff => (-3.0 - 0.15 * deepest, JUMP),
        Closed::Dmt | Closed::Jkr => (-1.6 * stretch - 0.3 * deepest, JUMP * stretch),
    };
    let mut places = vec![0.0];
    places.extend((0..=STATES).map(|at| {
        let share = at as f64 / STATES as f64;
        if share < FREE {
            start * (1.0 - share / FREE)
        } else {
            deepest * ((share - FREE) / (1.0 - FREE)).powf(1.3)
        }
    }));
    let grip = jkr::approach(&sphere, jkr::grip() * sphere.maugis_scales()?.radius);
    match closed {
        Closed::Stiff => {}
        Closed::Dmt => places.push(-jump),
        Closed::Jkr => places.extend([-jump, grip * (1.0 - JUMP), grip - jump]),
    }
    places.sort_by(f64::total_cmp);
    places.dedup();
    let back: Vec<f64> = places.iter().rev().skip(1).copied().collect();
    let (there, back) = match closed {
        Closed::Stiff => (maugis(problem, &places)?, maugis(problem, &back)?),
        Closed::Dmt => (dmt_itself(&sphere, &places)?, dmt_itself(&sphere, &back)?),
        Closed::Jkr => (
            jkr_itself(&sphere, &places, 0.0)?,
            jkr_itself(&sphere, &back, grip)?,
        ),
    };
    let back = places.iter().rev().skip(1).copied().zip(back);
    Ok(places.iter().copied().zip(there).chain(back).collect())
}

fn dmt_itself(sphere: &Sphere, approaches: &[f64]) -> Result<Vec<f64>, TheoryError> {
    let force = |approach: &f64| {
        if *approach < 0.0 {
            return Ok(0.0);
        }
        let radius = hertz::contact_radius_at_approach(sphere, *approach)?;
        Ok(hertz::force(sphere, radius) - TAU)
    };
    approaches.iter().map(force).collect()
}

/// Free below an approach.
fn jkr_itself(sphere: &Sphere, approaches: &[f64], free: f64) -> Result<Vec<f64>, TheoryError> {
    let force = |approach: &f64| {
        if *approach < free {
            return Ok(0.0);
        }
        let radius = jkr::contact_radius_at_approach(sphere, *approach)?;
        Ok(jkr::force(sphere, radius))
    };
    approaches.iter().map(force).collect()
}

/// Forces of a sphere with the law of Maugis and Dugdale at approaches, loaded or unloaded alike; below a Tabor number of
/// 0.5 nothing jumps.
pub fn maugis(problem: &Problem, approaches: &[f64]) -> Result<Vec<f64>, TheoryError> {
    let stiffness = 4.0 / 3.0 * problem.modulus();
    let truth = Parameters {
        contact_modulus: problem.modulus(),
        work_of_adhesion: 1.0,
        // The peak tension is 1.
        maugis_parameter: 2.0 / (PI * stiffness * stiffness).cbrt(),
        approach_offset: 0.0,
        force_offset: 0.0,
        baseline_slope: 0.0,
    };
    IndenterModel::new(Model::MaugisDugdale, 1.0).forces(&truth, approaches)
}
