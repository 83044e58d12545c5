//! Work of adhesion and modulus from two numbers of a curve: pull-off force and a stiffness.
//!
//! For data where only these two numbers are known. Assumes JKR; see
//! [`crate::theory::jkr::from_measurement`].

use super::curve_file::Sample;
use super::estimate::ModelFit;
use super::measured::Measured;
use crate::theory::jkr;

/// Share of the greatest load at which the stiffness is taken.
const AT: f64 = 0.5;
/// Range of loads for the linear fit of the stiffness, as shares of the greatest load.
const BETWEEN: (f64, f64) = (0.3, 0.7);
/// Fewest points of that linear fit.
const LEAST_POINTS: usize = 5;

/// The two numbers, and the JKR result.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Inversion {
    /// Greatest tension, N, positive.
    pub pull_off_force: f64,
    /// Load at which the stiffness was taken, N.
    pub load: f64,
    /// Slope of force against approach on unloading, N/m.
    pub stiffness: f64,
    /// Work of adhesion, J/m^2.
    pub work_of_adhesion: f64,
    /// Its standard deviation, J/m^2.
    pub work_uncertainty: f64,
    /// Contact modulus, Pa.
    pub contact_modulus: f64,
    /// Its standard deviation, Pa.
    pub modulus_uncertainty: f64,
}

/// The inversion of a curve, with force offset and noise of `fit`; `None` if the tip is no sphere, or the curve has no
/// tension or too few points of compression on unloading.
pub fn invert_curve(measured: &Measured, fit: &ModelFit) -> Option<Inversion> {
    let radius = measured.indenter.radius()?;
    let zero = fit.parameters.force_offset;
    let (least, greatest) = measured.extremes();
    let (pull_off, most) = (zero - least.force, greatest.force - zero);
    if pull_off <= 3.0 * fit.noise || most <= 0.0 {
        return None;
    }
    // The last unloading segment, else the last loading segment.
    let unloading = measured.segments.iter().rfind(|segment| !segment.loading);
    let segment = unloading.or(measured.segments.last())?;
    let points: Vec<&Sample> = measured.samples[segment.points.clone()]
        .iter()
        .filter(|sample| {
            let load = sample.force - zero;
            (BETWEEN.0 * most..=BETWEEN.1 * most).contains(&load)
        })
        .collect();
    if points.len() < LEAST_POINTS {
        return None;
    }
    let count = points.len() as f64;
    let mean = |of: fn(&Sample) -> f64| points.iter().map(|s| of(s)).sum::<f64>() / count;
    let (approach, force) = (mean(|s| s.approach), mean(|s| s.force));
    let (mut square, mut product) = (0.0, 0.0);
    for sample in &points {
        square += (sample.approach - approach).powi(2);
        product += (sample.approach - approach) * (sample.force - force);
    }
    let stiffness = product / square;
    let slope_noise = fit.noise / square.sqrt();
    let load = AT * most;
    let invert = |pull_off: f64, stiffness: f64| {
        jkr::from_measurement(radius, pull_off, load, stiffness).ok()
    };
    let sphere = invert(pull_off, stiffness)?;
    let moved = [
        invert(pull_off + fit.noise, stiffness)?,
        invert(pull_off, stiffness + slope_noise)?,
    ];
    let spread = |of: fn(&crate::theory::Sphere) -> f64| {
        let parts = moved.iter().map(|other| (of(other) - of(&sphere)).powi(2));
        parts.sum::<f64>().sqrt()
    };
    Some(Inversion {
        pull_off_force: pull_off,
        load,
        stiffness,
        work_of_adhesion: sphere.work_of_adhesion(),
        work_uncertainty: spread(|sphere| sphere.work_of_adhesion()),
        contact_modulus: sphere.contact_modulus(),
        modulus_uncertainty: spread(|sphere| sphere.contact_modulus()),
    })
}
