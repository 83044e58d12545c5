//! One relaxation time of a solid, from the loading of a force curve.
//!
//! While the contact grows, the force of a rigid tip on a viscoelastic half-space is
//! `F(t) = c int E*(t - s) d(delta^p)/ds ds`, where `c E* delta^p` is the elastic force: Lee & Radok 1960,
//! doi:10.1115/1.3644020, and for any tip Ting 1966, doi:10.1115/1.3625192. Here `E*(t) = E1 + E2 exp(-t/tau)`, a standard
//! linear solid, without adhesion. Between two points the power of the approach is linear in time.

use std::fmt;
use std::path::Path;

use nalgebra::{DMatrix, DVector};

use super::choice::FitResult;
use super::curve_file::{ForceCurve, name};
use super::error::FitError;
use super::least_squares::{Problem, covariance, minimise};
use crate::units::format_si;

/// Fewest points in contact.
const LEAST_POINTS: usize = 10;
/// Relaxation times tried first, as shares of the time in contact, and places of first touch, as shares of the indentation.
const TIMES: [f64; 9] = [0.01, 0.03, 0.06, 0.1, 0.2, 0.4, 0.8, 1.6, 4.0];
const PLACES: [f64; 7] = [-0.2, -0.1, -0.05, 0.0, 0.05, 0.1, 0.2];

/// A standard linear solid.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Relaxation {
    /// Contact modulus after long times, Pa, with its standard deviation; NaN where the curve does not determine it.
    pub relaxed_modulus: (f64, f64),
    /// Contact modulus of sudden loads, Pa.
    pub instantaneous_modulus: (f64, f64),
    /// Relaxation time, s.
    pub time: (f64, f64),
    /// Standard deviation of the residuals, N.
    pub noise: f64,
    /// Points of loading that were fitted.
    pub points: usize,
}

impl fmt::Display for Relaxation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let is_known = self.time.1 < self.time.0;
        if !is_known {
            return write!(f, "the loading determines no relaxation time");
        }
        let with = |(value, deviation): (f64, f64), unit: &str| {
            format!(
                "{} +- {}",
                format_si(value, unit),
                format_si(deviation, unit)
            )
        };
        write!(
            f,
            "standard linear solid, on loading: E* = {} relaxed, {} at once, relaxation time {}",
            with(self.relaxed_modulus, "Pa"),
            with(self.instantaneous_modulus, "Pa"),
            with(self.time, "s"),
        )
    }
}

/// Fits a relaxation time to the loading of a curve whose elastic fit is `result`; `path` is for messages.
///
/// # Errors
/// Times that are missing or do not increase; too few points of loading in contact.
pub fn fit_relaxation(
    curve: &ForceCurve,
    path: &Path,
    result: &FitResult,
) -> Result<Relaxation, FitError> {
    let measured = &result.measured;
    let no_loading = |points| FitError::NoLoading {
        path: name(path),
        points,
    };
    let loading = measured.segments.iter().rfind(|segment| segment.loading);
    let points = loading.ok_or_else(|| no_loading(0))?.points.clone();
    // The contact grows up to the deepest point.
    let deeper = |a: &usize, b: &usize| {
        let [a, b] = [*a, *b].map(|at| measured.approaches[at]);
        a.total_cmp(&b)
    };
    let last = points
        .clone()
        .rev()
        .max_by(deeper)
        .ok_or_else(|| no_loading(0))?;
    let points = points.start..last + 1;
    let times = curve.times.get(points.clone()).unwrap_or_default();
    let increase = times.windows(2).all(|pair| pair[0] < pair[1]);
    if times.len() != points.len() || !increase || !times.iter().all(|time| time.is_finite()) {
        return Err(FitError::NoTime { path: name(path) });
    }
    let touch = result.best().parameters.approach_offset;
    let approaches = &measured.approaches[points.clone()];
    let deepest = approaches.iter().copied().fold(f64::NEG_INFINITY, f64::max) - touch;
    let in_contact = approaches
        .iter()
        .filter(|approach| **approach > touch)
        .count();
    if in_contact < LEAST_POINTS {
        return Err(no_loading(in_contact));
    }
    let samples = &measured.samples[points];
    let contact_time = times[times.len() - 1] - times[times.len() - in_contact];
    let fit = Loading {
        times,
        approaches,
        forces: samples.iter().map(|sample| sample.force).collect(),
        power: measured.indenter.power(),
        stiffness: measured.indenter.stiffness(),
        scale: measured.force_span,
        baseline: result.best().parameters.force_offset,
        is_free: measured.freedom.approach_offset,
        start: Solid {
            moduli: [0.0; 2],
            time: contact_time,
            touch,
        },
        depth: deepest,
    };
    let start = fit.first().ok_or_else(|| no_loading(in_contact))?;
    let fit = Loading { start, ..fit };
    let variables = if fit.is_free { 4 } else { 3 };
    let minimum =
        minimise(&fit, DVector::zeros(variables)).ok_or_else(|| no_loading(in_contact))?;
    let degrees = (times.len() - variables).max(1);
    let variance = minimum.sum() / degrees as f64;
    let known = covariance(&minimum.jacobian, variance);
    let solid = fit.solid(&minimum.variables);
    let deviation = |place: usize| known[(place, place)].sqrt();
    let [relaxed, rest] = solid.moduli;
    let both = known[(0, 0)] * relaxed * relaxed
        + known[(1, 1)] * rest * rest
        + 2.0 * known[(0, 1)] * relaxed * rest;
    Ok(Relaxation {
        relaxed_modulus: (relaxed, deviation(0) * relaxed),
        instantaneous_modulus: (relaxed + rest, both.sqrt()),
        time: (solid.time, deviation(2) * solid.time),
        noise: variance.sqrt() * fit.scale,
        points: times.len(),
    })
}

/// A standard linear solid and the approach of first touch.
#[derive(Clone, Copy, Debug)]
struct Solid {
    /// Relaxed modulus, and that which relaxes, Pa.
    moduli: [f64; 2],
    time: f64,
    touch: f64,
}

/// The loading of a curve. Variables are the logarithms of both moduli and of the time, and the place of first touch over the
/// depth, about a start.
struct Loading<'a> {
    times: &'a [f64],
    approaches: &'a [f64],
    forces: Vec<f64>,
    power: f64,
    stiffness: f64,
    scale: f64,
    baseline: f64,
    is_free: bool,
    start: Solid,
    depth: f64,
}

impl Loading<'_> {
    /// The power of the approach, and the same with a memory that fades over `time`.
    fn parts(&self, time: f64, touch: f64) -> Vec<[f64; 2]> {
        let power = |approach: f64| (approach - touch).max(0.0).powf(self.power);
        let mut before = (self.times[0], power(self.approaches[0]));
        let mut faded = before.1;
        let points = self.times.iter().zip(self.approaches);
        points
            .map(|(&at, approach)| {
                let now = power(*approach);
                let over = (at - before.0) / time;
                // The mean of exp(-s/tau) over the step, for a power that grows evenly.
                let share = if over > 0.0 {
                    -(-over).exp_m1() / over
                } else {
                    1.0
                };
                faded = faded * (-over).exp() + (now - before.1) * share;
                before = (at, now);
                [now, faded]
            })
            .collect()
    }

    /// The best solid on a grid of times and places, both moduli by linear least squares.
    fn first(&self) -> Option<Solid> {
        let places: &[f64] = if self.is_free { &PLACES } else { &[0.0] };
        let tried = TIMES
            .iter()
            .flat_map(|time| places.iter().map(move |place| (time, place)));
        let found = tried.filter_map(|(time, place)| {
            let (time, touch) = (
                time * self.start.time,
                self.start.touch + place * self.depth,
            );
            let rows = self.parts(time, touch);
            let matrix = DMatrix::from_fn(rows.len(), 2, |i, j| self.stiffness * rows[i][j]);
            let forces = DVector::from_fn(rows.len(), |i, _| self.forces[i] - self.baseline);
            let solved = (matrix.tr_mul(&matrix))
                .lu()
                .solve(&matrix.tr_mul(&forces))?;
            let rest = (&matrix * &solved - forces).norm_squared();
            let moduli = [solved[0], solved[1]];
            let is_solid = moduli
                .iter()
                .all(|modulus| *modulus > 0.0 && modulus.is_finite());
            is_solid.then_some((
                rest,
                Solid {
                    moduli,
                    time,
                    touch,
                },
            ))
        });
        let best = found.min_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(_, solid)| solid)
    }

    fn solid(&self, variables: &DVector<f64>) -> Solid {
        let Solid {
            moduli,
            time,
            touch,
        } = self.start;
        let place = if self.is_free { variables[3] } else { 0.0 };
        Solid {
            moduli: [
                moduli[0] * variables[0].exp(),
                moduli[1] * variables[1].exp(),
            ],
            time: time * variables[2].exp(),
            touch: touch + place * self.depth,
        }
    }
}

impl Problem for Loading<'_> {
    type Choice = ();

    fn choose(&self, variables: &DVector<f64>) -> Option<((), DVector<f64>)> {
        Some(((), self.residuals(variables, &())?))
    }

    fn residuals(&self, variables: &DVector<f64>, (): &()) -> Option<DVector<f64>> {
        let Solid {
            moduli,
            time,
            touch,
        } = self.solid(variables);
        let rows = self.parts(time, touch);
        let residuals = rows.iter().zip(&self.forces).map(|(row, force)| {
            let model = self.stiffness * (moduli[0] * row[0] + moduli[1] * row[1]);
            (self.baseline + model - force) / self.scale
        });
        let residuals = DVector::from_iterator(rows.len(), residuals);
        residuals
            .iter()
            .all(|value| value.is_finite())
            .then_some(residuals)
    }
}
