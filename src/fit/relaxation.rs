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
use super::profile::MOST_RISE;
use super::scatter::Scatter;
use super::segments::Segment;
use crate::units::format_si;

/// Fewest points in contact.
const LEAST_POINTS: usize = 10;
/// Relaxation times of the profile: from and to these shares of the time in contact, and how many.
const TIMES: (f64, f64) = (1e-3, 1e2);
const PROFILE: usize = 31;
/// Profile states from which the time is freed.
const BEST_TIMES: usize = 3;
/// Share of the greatest force that marks the contact.
const MARK: f64 = 0.2;
/// Places of first touch tried first: before the mark, as shares of the approach from there to the deepest point. Without
/// relaxation a sphere touches 0.5 before it and a cone 0.8; a solid that is slow at first, farther.
const PLACES: [f64; 18] = [
    -0.2, -0.1, 0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.5, 2.0, 3.0, 4.0,
];
/// The share of [`PLACES`] that the time in contact is counted from.
const USUAL_PLACE: f64 = 0.5;
/// Most points of the tries.
const TRIED_POINTS: usize = 2000;
/// Share of itself that the uncertainty of a stated number stays below: two deviations do not reach to nothing. A modulus that
/// runs off without bound as the time goes to 0 has an uncertainty of nearly its size.
const KNOWN: f64 = 0.5;
/// Step of the derivatives by the place, as a share of the depth, and by the logarithm of the time.
const DIFFERENCE: f64 = 1e-5;

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
    };
    let elastic = result.best().parameters.approach_offset;
    let (places, contact_time) = loading.places(elastic, measured.freedom.approach_offset);
    let profile = loading.profile(&places, contact_time);
    let mut best_first: Vec<&State> = profile.iter().collect();
    best_first.sort_by(|a, b| a.sum.total_cmp(&b.sum));
    best_first.truncate(BEST_TIMES);
    let is_free = places.len() > 1;
    let freed = best_first
        .iter()
        .filter_map(|state| loading.descend(**state, true, is_free));
    let best = freed.chain(best_first.iter().map(|state| **state));
    let best = best.min_by(|a, b| a.sum.total_cmp(&b.sum));
    let best = best.ok_or_else(|| no_loading(0))?;
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

/// A relaxation time and a place of first touch, with the sum of squares of the best moduli, in squares of the scale.
#[derive(Clone, Copy, Debug)]
struct State {
    time: f64,
    touch: f64,
    sum: f64,
}

/// The loading of a curve.
#[derive(Clone, Debug)]
struct Loading {
    times: Vec<f64>,
    approaches: Vec<f64>,
    /// Above the estimated baseline.
    forces: Vec<f64>,
    power: f64,
    stiffness: f64,
    scale: f64,
    is_level_known: bool,
}

impl Loading {
    /// The power of the approach, and the same with a memory that fades over `time`, as forces of a modulus of 1 over the
    /// scale.
    fn parts(&self, time: f64, touch: f64) -> [DVector<f64>; 2] {
        let unit = self.stiffness / self.scale;
        let power = |approach: f64| unit * (approach - touch).max(0.0).powf(self.power);
        let mut before = (self.times[0], power(self.approaches[0]));
        let mut faded = before.1;
        let mut parts = [0, 1].map(|_| DVector::zeros(self.times.len()));
        for (i, (&at, approach)) in self.times.iter().zip(&self.approaches).enumerate() {
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
            (parts[0][i], parts[1][i]) = (now, faded);
        }
        parts
    }

    /// Relaxed modulus and that which relaxes, neither below 0, by linear least squares, and the residuals.
    fn solid(&self, time: f64, touch: f64) -> ([f64; 2], DVector<f64>) {
        let mut parts = self.parts(time, touch);
        let mut forces = DVector::from_fn(self.forces.len(), |i, _| self.forces[i] / self.scale);
        if !self.is_level_known {
            // The best baseline takes out the means.
            for column in parts.iter_mut().chain([&mut forces]) {
                column.add_scalar_mut(-column.mean());
            }
        }
        let [now, faded] = &parts;
        let (a, b, c) = (now.norm_squared(), now.dot(faded), faded.norm_squared());
        let (p, q) = (now.dot(&forces), faded.dot(&forces));
        let over = |product: f64, square: f64| {
            if square > 0.0 {
                (product / square).max(0.0)
            } else {
                0.0
            }
        };
        let (alone, fading) = (over(p, a), over(q, c));
        let determinant = a * c - b * b;
        let both = [c * p - b * q, a * q - b * p].map(|product| product / determinant);
        let is_solid = both
            .iter()
            .all(|modulus| modulus.is_finite() && *modulus >= 0.0);
        let moduli = if is_solid && determinant > 0.0 {
            both
        } else if alone * alone * a >= fading * fading * c {
            [alone, 0.0]
        } else {
            [0.0, fading]
        };
        let residuals = now * moduli[0] + faded * moduli[1] - forces;
        (moduli, residuals)
    }

    fn state(&self, time: f64, touch: f64) -> State {
        let sum = self.solid(time, touch).1.norm_squared();
        State { time, touch, sum }
    }

    fn deepest(&self) -> f64 {
        self.approaches[self.approaches.len() - 1]
    }

    /// Places where the surfaces may touch first, and about the time in contact. `elastic` is the place of the elastic fit,
    /// which may be far off: where the solid relaxes it takes the bend for adhesion.
    fn places(&self, elastic: f64, is_free: bool) -> (Vec<f64>, f64) {
        let greatest = self.forces.iter().copied().fold(0.0, f64::max);
        let light = self
            .forces
            .iter()
            .rposition(|force| *force < MARK * greatest);
        let mark = self.approaches[light.unwrap_or(0)];
        let mut depth = self.deepest() - mark;
        if depth <= 0.0 {
            depth = self.deepest() - self.approaches[0];
        }
        let (places, usual) = if is_free {
            let places = PLACES.iter().map(|place| mark - place * depth);
            (
                places.chain([elastic]).collect(),
                mark - USUAL_PLACE * depth,
            )
        } else {
            (vec![elastic], elastic)
        };
        let begin = self.approaches.iter().rposition(|x| *x <= usual);
        let [begin, end] = [begin.unwrap_or(0), self.times.len() - 1].map(|at| self.times[at]);
        let contact_time = if end > begin {
            end - begin
        } else {
            end - self.times[0]
        };
        (places, contact_time)
    }

    /// The least sum of squares at each of several relaxation times.
    fn profile(&self, places: &[f64], contact_time: f64) -> Vec<State> {
        let every = self.times.len().div_ceil(TRIED_POINTS);
        // Counted from the end, which is the deepest point.
        let thinned = |values: &[f64]| {
            let mut kept: Vec<f64> = values.iter().rev().step_by(every).copied().collect();
            kept.reverse();
            kept
        };
        let few = Loading {
            times: thinned(&self.times),
            approaches: thinned(&self.approaches),
            forces: thinned(&self.forces),
            ..*self
        };
        let growth = (TIMES.1 / TIMES.0).powf(1.0 / (PROFILE - 1) as f64);
        let times = (0..PROFILE).map(|i| contact_time * TIMES.0 * growth.powi(i as i32));
        times
            .filter_map(|time| {
                let tried = places.iter().map(|touch| few.state(time, *touch));
                let best = tried.min_by(|a, b| a.sum.total_cmp(&b.sum))?;
                let best = self.state(best.time, best.touch);
                let descended = self.descend(best, false, places.len() > 1);
                Some(descended.unwrap_or(best))
            })
            .collect()
    }

    /// The minimum reached from a state, with its time free or not, and its place.
    fn descend(&self, start: State, time: bool, touch: bool) -> Option<State> {
        let descent = Descent {
            loading: self,
            start,
            time,
            depth: (self.deepest() - start.touch).abs(),
        };
        let variables = usize::from(time) + usize::from(touch);
        if variables == 0 {
            return None;
        }
        let minimum = minimise(&descent, DVector::zeros(variables))?;
        let (time, touch) = descent.numbers(&minimum.variables);
        let sum = minimum.sum();
        Some(State { time, touch, sum }).filter(|state| state.sum.is_finite())
    }

    /// Standard deviations of both moduli and the time, from the covariance, at that time or with the time free.
    fn deviations(&self, state: &State, time: bool, touch: bool, variance: f64) -> [f64; 3] {
        let [now, faded] = self.parts(state.time, state.touch);
        let (moduli, _) = self.solid(state.time, state.touch);
        let force = |time: f64, touch: f64| {
            let [now, faded] = self.parts(time, touch);
            now * moduli[0] + faded * moduli[1]
        };
        // All variables are of the order of 1.
        let (modulus, depth) = (moduli[0] + moduli[1], (self.deepest() - state.touch).abs());
        let mut columns = vec![now * modulus, faded * modulus];
        if time {
            let at = |step: f64| force(state.time * step.exp(), state.touch);
            columns.push((at(DIFFERENCE) - at(-DIFFERENCE)) / (2.0 * DIFFERENCE));
        }
        if touch {
            let at = |step: f64| force(state.time, state.touch + depth * step);
            columns.push((at(DIFFERENCE) - at(-DIFFERENCE)) / (2.0 * DIFFERENCE));
        }
        if !self.is_level_known {
            for column in &mut columns {
                column.add_scalar_mut(-column.mean());
            }
        }
        let known = covariance(&DMatrix::from_columns(&columns), variance);
        let both = known[(0, 0)] + known[(1, 1)] + 2.0 * known[(0, 1)];
        let time = if time {
            known[(2, 2)].sqrt() * state.time
        } else {
            0.0
        };
        let alone = known[(0, 0)].sqrt();
        [modulus * alone, modulus * both.max(0.0).sqrt(), time]
    }
}

/// The search for time and place about a start: variables are the logarithm of the time, where it is free, and the place
/// over the depth.
struct Descent<'a> {
    loading: &'a Loading,
    start: State,
    time: bool,
    depth: f64,
}

impl Descent<'_> {
    fn numbers(&self, variables: &DVector<f64>) -> (f64, f64) {
        let State { time, touch, .. } = self.start;
        let (faster, places) = if self.time {
            (variables[0].exp(), variables.get(1))
        } else {
            (1.0, variables.get(0))
        };
        let place = places.copied().unwrap_or(0.0);
        (time * faster, touch + place * self.depth)
    }
}

impl Problem for Descent<'_> {
    type Choice = ();

    fn choose(&self, variables: &DVector<f64>) -> Option<((), DVector<f64>)> {
        Some(((), self.residuals(variables, &())?))
    }

    fn residuals(&self, variables: &DVector<f64>, (): &()) -> Option<DVector<f64>> {
        let (time, touch) = self.numbers(variables);
        let (_, residuals) = self.loading.solid(time, touch);
        let are_finite = residuals.iter().all(|value| value.is_finite());
        are_finite.then_some(residuals)
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
