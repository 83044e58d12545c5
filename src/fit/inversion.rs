//! Work of adhesion and modulus from two numbers of a curve: pull-off force and a stiffness.
//!
//! For data where only these two numbers are known. Assumes JKR; see
//! [`crate::theory::jkr::from_measurement`].

use nalgebra::{Matrix3, RowVector3, Vector3};

use super::curve_file::Sample;
use super::estimate::ModelFit;
use super::measured::Measured;
use super::segments::Segment;
use crate::theory::{Sphere, jkr};

/// Share of the greatest load at which the stiffness is taken.
const AT: f64 = 0.5;
/// Range of loads of the parabola that has the stiffness, as shares of the greatest load.
const BETWEEN: (f64, f64) = (0.3, 0.7);
/// Fewest points of a parabola.
const LEAST_POINTS: usize = 5;
/// Distance on both sides of pull-off that its parabola covers, as a share of the approach from pull-off to zero force. With JKR it
/// misses the minimum by 0.03 %.
const AROUND: f64 = 0.2;
/// The same at most where that holds too few points.
const AROUND_AT_MOST: f64 = 0.5;
/// Deviations of the noise that the pull-off force must exceed.
const BEYOND_NOISE: f64 = 3.0;

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
    /// Its standard deviation, J/m^2; NaN where the curve does not determine the baseline, as in the next.
    pub work_uncertainty: f64,
    /// Contact modulus, Pa.
    pub contact_modulus: f64,
    /// Its standard deviation, Pa.
    pub modulus_uncertainty: f64,
}

/// The inversion of a curve, with force offset and noise of `fit`; `None` if the tip is no sphere, the model does not adhere, or the
/// curve has no tension or too few points of compression on unloading.
pub fn invert_curve(measured: &Measured, fit: &ModelFit) -> Option<Inversion> {
    let radius = measured.indenter.radius()?;
    if !fit.model.adheres() {
        // The least force of many points of noise would be a pull-off.
        return None;
    }
    let zero = fit.parameters.force_offset;
    let most = measured.extremes().1.force - zero;
    // The last unloading segment, else the last loading segment.
    let unloading = measured.segments.iter().rfind(|segment| !segment.loading);
    let segment = unloading.or(measured.segments.last())?;
    let (least, least_error, at) = least_force(measured, fit, segment)?;
    let pull_off = zero - least;
    // Of a baseline with a slope: its force is less certain away from the middle of the curve, and the slope is part of the
    // stiffness.
    let zero_error = fit.baseline_error.of_force(at);
    let tilt_error = fit.baseline_error.of_slope();
    let is_known = zero_error.is_finite() && tilt_error.is_finite();
    if pull_off <= BEYOND_NOISE * fit.noise || most <= 0.0 {
        return None;
    }
    // By the loads of the model: those of the points are noisy, and choosing by them would flatten the slope.
    let loaded =
        |at: &usize| (BETWEEN.0 * most..=BETWEEN.1 * most).contains(&(fit.fitted[*at] - zero));
    let points: Vec<Sample> = segment
        .points
        .clone()
        .filter(loaded)
        .map(|at| measured.samples[at])
        .collect();
    let load = AT * most;
    let (stiffness, slope_error) = Parabola::through(&points)?.slope_at(zero + load)?;
    // The noise of a deflection is in the approach too.
    let spring = measured.beam.as_ref().map(|beam| beam.spring);
    let amplified = spring.map_or(1.0, |spring| 1.0 + (stiffness / spring).max(0.0));
    let invert = |pull_off: f64, stiffness: f64| {
        jkr::from_measurement(radius, pull_off, load, stiffness).ok()
    };
    let sphere = invert(pull_off, stiffness)?;
    let moved = [
        invert(
            pull_off + (fit.noise * least_error).hypot(zero_error.max(0.0)),
            stiffness,
        )?,
        invert(
            pull_off,
            stiffness + (amplified * fit.noise * slope_error).hypot(tilt_error.max(0.0)),
        )?,
    ];
    let spread = |of: fn(&Sphere) -> f64| {
        let parts = moved.iter().map(|other| (of(other) - of(&sphere)).powi(2));
        if is_known {
            parts.sum::<f64>().sqrt()
        } else {
            f64::NAN
        }
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

/// Least force in contact, its standard deviation in those of the noise, and about its approach: of a parabola through the points about it, since the
/// least of many points is low by its noise. Where too few points lie there it is the least point.
fn least_force(measured: &Measured, fit: &ModelFit, segment: &Segment) -> Option<(f64, f64, f64)> {
    let contact: Vec<usize> = segment
        .points
        .clone()
        .filter(|at| fit.interacting.get(*at) == Some(&true))
        .collect();
    let by_model = |a: &&usize, b: &&usize| fit.fitted[**a].total_cmp(&fit.fitted[**b]);
    let centre = measured.approaches[*contact.iter().min_by(by_model)?];
    let pressed = contact
        .iter()
        .filter(|at| fit.fitted[**at] >= fit.parameters.force_offset)
        .map(|at| measured.approaches[*at]);
    let to_zero = pressed.fold(f64::INFINITY, f64::min) - centre;
    let mut near: Vec<Sample> = contact.iter().map(|at| measured.samples[*at]).collect();
    let distance = |sample: &Sample| (sample.approach - centre).abs();
    near.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let within = |share: f64| near.partition_point(|sample| distance(sample) <= share * to_zero);
    let count = within(AROUND).max(LEAST_POINTS);
    let parabola = if to_zero.is_finite() && count <= within(AROUND_AT_MOST) {
        Parabola::through(&near[..count])
    } else {
        None
    };
    let least = near.iter().map(|sample| sample.force);
    let least = least.fold(f64::INFINITY, f64::min);
    let (least, error) = parabola.map_or((least, 1.0), |parabola| parabola.least());
    Some((least, error, centre))
}

/// A parabola through points by least squares.
struct Parabola {
    /// Half of the range of the approach, m.
    half: f64,
    /// By the place from -1 to 1 in the range.
    coefficients: Vector3<f64>,
    /// Covariance of the coefficients at a variance of the noise of 1.
    covariance: Matrix3<f64>,
}

impl Parabola {
    fn through(points: &[Sample]) -> Option<Self> {
        let approaches = || points.iter().map(|sample| sample.approach);
        let low = approaches().fold(f64::INFINITY, f64::min);
        let high = approaches().fold(f64::NEG_INFINITY, f64::max);
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        if points.len() < LEAST_POINTS || half <= 0.0 {
            return None;
        }
        let mut normal = Matrix3::zeros();
        let mut right = Vector3::zeros();
        for sample in points {
            let row = value_at((sample.approach - middle) / half);
            normal += row.transpose() * row;
            right += row.transpose() * sample.force;
        }
        let covariance = normal.try_inverse()?;
        Some(Parabola {
            half,
            coefficients: covariance * right,
            covariance,
        })
    }

    /// Standard deviation of a linear combination of the coefficients, in those of the noise.
    fn deviation(&self, weights: RowVector3<f64>) -> f64 {
        (weights * self.covariance * weights.transpose())[0]
            .max(0.0)
            .sqrt()
    }

    /// Least value in the range, with its deviation.
    fn least(&self) -> (f64, f64) {
        let [_, slope, bend] = self.coefficients.into();
        let bottom = if bend > 0.0 {
            -0.5 * slope / bend
        } else {
            -1.0
        };
        let value = |place: f64| (value_at(place) * self.coefficients)[0];
        let place = [-1.0, 1.0, bottom.clamp(-1.0, 1.0)]
            .into_iter()
            .min_by(|a, b| value(*a).total_cmp(&value(*b)))
            .unwrap_or(bottom);
        (value(place), self.deviation(value_at(place)))
    }

    /// Slope where the force grows through a value, with its deviation; `None` if it does not within the range.
    fn slope_at(&self, force: f64) -> Option<(f64, f64)> {
        let [constant, slope, bend] = self.coefficients.into();
        let there = (slope * slope - 4.0 * bend * (constant - force)).sqrt();
        let place = 2.0 * (force - constant) / (slope + there);
        if !(there > 0.0 && place.abs() <= 1.0) {
            return None;
        }
        // The place moves with the coefficients, too.
        let weights =
            RowVector3::new(0.0, 1.0, 2.0 * place) - value_at(place) * (2.0 * bend / there);
        Some((there / self.half, self.deviation(weights) / self.half))
    }
}

fn value_at(place: f64) -> RowVector3<f64> {
    RowVector3::new(1.0, place, place * place)
}
