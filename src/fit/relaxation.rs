//! One relaxation time of a solid, from the loading of a force curve.
//!
//! While the contact grows, the force of a rigid tip on a viscoelastic half-space is
//! `F(t) = c int E*(t - s) d(delta^p)/ds ds`, where `c E* delta^p` is the elastic force: Lee & Radok 1960,
//! doi:10.1115/1.3644020, and for any tip Ting 1966, doi:10.1115/1.3625192. Here `E*(t) = E1 + E2 exp(-t/tau)`, a standard
//! linear solid, without adhesion. Between two points the power of the approach is linear in time.

use std::fmt;
use std::path::Path;

use super::choice::FitResult;
use super::curve_file::{ForceCurve, name};
use super::error::FitError;
use super::loading::{Loading, State};
use super::profile::MOST_RISE;
use super::scatter::Scatter;
use super::segments::Segment;
use crate::units::format_si;

/// Fewest points in contact.
const LEAST_POINTS: usize = 10;
/// Profile states from which the time is freed.
const BEST_TIMES: usize = 3;
/// Rounds in which approaches follow from positions and the forces of the solid.
const ROUNDS: usize = 3;
/// Share of itself that the uncertainty of a stated number stays below: two deviations do not reach to nothing. A modulus that
/// runs off without bound as the time goes to 0 has an uncertainty of nearly its size.
const KNOWN: f64 = 0.5;

/// A standard linear solid.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Relaxation {
    /// Contact modulus after long times, Pa, with its standard deviation; both NaN where the curve does not determine it.
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
        let known = |(value, deviation): (f64, f64), unit: &str, words: &str| {
            value.is_finite().then(|| {
                let [value, deviation] = [value, deviation].map(|number| format_si(number, unit));
                format!("{value} +- {deviation}{words}")
            })
        };
        let moduli = [
            known(self.relaxed_modulus, "Pa", " relaxed"),
            known(self.instantaneous_modulus, "Pa", " at once"),
        ];
        let moduli: Vec<String> = moduli.into_iter().flatten().collect();
        let mut parts = Vec::new();
        if !moduli.is_empty() {
            parts.push(format!("E* = {}", moduli.join(", ")));
        }
        match known(self.time, "s", "") {
            Some(time) => parts.push(format!("relaxation time {time}")),
            None => parts.push("the loading determines no relaxation time".to_owned()),
        }
        write!(f, "standard linear solid, on loading: {}", parts.join(", "))
    }
}

/// Fits a relaxation time to the loading of a curve whose elastic fit is `result`; `path` is for messages.
///
/// # Errors
/// Times that are missing, of another unit, or do not increase; too few points of loading in contact.
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
    if let Some(reason) = curve.no_time.clone() {
        return Err(FitError::UnreadTime { reason });
    }
    let times = curve.times.get(points.clone()).unwrap_or_default();
    let increase = times.windows(2).all(|pair| pair[0] < pair[1]);
    if times.len() != points.len() || !increase || !times.iter().all(|time| time.is_finite()) {
        return Err(FitError::NoTime { path: name(path) });
    }
    if times.len() < LEAST_POINTS {
        return Err(no_loading(times.len()));
    }
    let baseline = measured.baseline();
    let samples = &measured.samples[points.clone()];
    let loading = Loading {
        times: times.to_vec(),
        approaches: measured.approaches[points].to_vec(),
        forces: samples
            .iter()
            .map(|sample| sample.force - baseline)
            .collect(),
        power: measured.indenter.power(),
        stiffness: measured.indenter.stiffness(),
        scale: measured.force_span,
        is_level_known: !measured.freedom.force_offset,
        weights: vec![1.0; times.len()],
    };
    let elastic = result.best().parameters.approach_offset;
    let (places, contact_time) = loading.places(elastic, measured.freedom.approach_offset);
    let is_free = places.len() > 1;
    let best_of = |loading: &Loading| {
        let profile = loading.profile(&places, contact_time);
        let mut best_first: Vec<&State> = profile.iter().collect();
        best_first.sort_by(|a, b| a.sum.total_cmp(&b.sum));
        best_first.truncate(BEST_TIMES);
        let freed = best_first
            .iter()
            .filter_map(|state| loading.descend(**state, true, is_free));
        let best = freed.chain(best_first.iter().map(|state| **state));
        let best = best.min_by(|a, b| a.sum.total_cmp(&b.sum));
        Some((best?, profile))
    };
    let as_measured = loading;
    let mut loading = as_measured.clone();
    let (mut best, mut profile) = best_of(&loading).ok_or_else(|| no_loading(0))?;
    if let Some(spring) = curve.spring.filter(|_| curve.has_positions) {
        for _ in 0..ROUNDS {
            loading = loading.at_positions(&as_measured, &best, spring);
            (best, profile) = best_of(&loading).ok_or_else(|| no_loading(0))?;
        }
    }
    let touches: Vec<bool> = (loading.approaches.iter().map(|x| *x > best.touch)).collect();
    let in_contact = touches.iter().filter(|touches| **touches).count();
    if in_contact < LEAST_POINTS {
        return Err(no_loading(in_contact));
    }
    let (solid, residuals) = loading.solid(best.time, best.touch);
    let free = 3 + usize::from(is_free) + usize::from(!loading.is_level_known);
    let degrees = times.len().saturating_sub(free).max(1);
    let whole = [Segment {
        points: 0..times.len(),
        loading: true,
    }];
    let variance = Scatter::new(&residuals, free, &whole, &touches).variance;
    let numbers = |time: f64, [relaxed, rest]: [f64; 2]| [relaxed, relaxed + rest, time];
    let values = numbers(best.time, solid);
    let mut deviations = loading.deviations(&best, true, is_free, variance);
    // The sum of squares is no parabola where the time is hardly known: each state that the loading does not rule out counts.
    for state in &profile {
        let rise = (state.sum - best.sum) / variance;
        if rise > MOST_RISE {
            continue;
        }
        let own = loading.deviations(state, false, is_free, variance);
        let there = numbers(state.time, loading.solid(state.time, state.touch).0);
        for at in 0..3 {
            let away = (there[at] - values[at]) / rise.max(1.0).sqrt();
            let away = if at == 2 { away } else { away.hypot(own[at]) };
            deviations[at] = deviations[at].max(away.abs());
        }
    }
    let stated = |at: usize| stated(values[at], deviations[at]);
    Ok(Relaxation {
        relaxed_modulus: stated(0),
        instantaneous_modulus: stated(1),
        time: stated(2),
        noise: (residuals.norm_squared() / degrees as f64).sqrt() * loading.scale,
        points: times.len(),
    })
}

/// A number with its standard deviation; NaN where that is too large to state it.
fn stated(value: f64, deviation: f64) -> (f64, f64) {
    if deviation < KNOWN * value {
        (value, deviation)
    } else {
        (f64::NAN, f64::NAN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A modulus at once that ran off, where the truth was 3 MPa, and one that is known.
    #[test]
    fn a_number_that_runs_off_is_not_stated() {
        assert!(stated(32.78e9, 32.77e9).0.is_nan() && stated(32.78e9, 32.77e9).1.is_nan());
        assert!(stated(1.0, f64::NAN).0.is_nan());
        assert_eq!(stated(3.1e6, 0.2e6), (3.1e6, 0.2e6));
    }
}
