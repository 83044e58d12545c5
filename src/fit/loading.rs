//! The loading of a curve of a solid that relaxes: the sum of squares at a relaxation time and a place of first touch, and its minimum.

use nalgebra::{DMatrix, DVector};

use super::least_squares::{Problem, covariance, minimise};

/// Relaxation times of the profile: from and to these shares of the time in contact, and how many.
const TIMES: (f64, f64) = (1e-3, 1e2);
const PROFILE: usize = 31;
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
/// Step of the derivatives by the place, as a share of the depth, and by the logarithm of the time.
const DIFFERENCE: f64 = 1e-5;

/// A relaxation time and a place of first touch, with the sum of squares of the best moduli, in squares of the scale.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub(super) time: f64,
    pub(super) touch: f64,
    pub(super) sum: f64,
}

/// The loading of a curve.
#[derive(Clone, Debug)]
pub(super) struct Loading {
    pub(super) times: Vec<f64>,
    pub(super) approaches: Vec<f64>,
    /// Above the estimated baseline.
    pub(super) forces: Vec<f64>,
    pub(super) power: f64,
    pub(super) stiffness: f64,
    pub(super) scale: f64,
    pub(super) is_level_known: bool,
    /// Share of a change of the contact's force that remains where the spring gives way; 1 where the approach is known.
    pub(super) weights: Vec<f64>,
}

impl Loading {
    /// The loading with the approaches of the known positions and the forces of a state, not with those that have the noise of the deflection: a
    /// round of Newton's method for `approach + force/spring = position`, and its rows of the least squares.
    pub(super) fn at_positions(
        &self,
        as_measured: &Loading,
        state: &State,
        spring: f64,
    ) -> Loading {
        let (moduli, _) = self.solid(state.time, state.touch);
        let weighted = |loading: &Loading| {
            let [now, faded] = loading.parts(state.time, state.touch);
            (now * moduli[0] + faded * moduli[1]) * self.scale
        };
        let contact = |loading: &Loading| {
            let forces = weighted(loading);
            let each = forces.iter().zip(&loading.weights);
            each.map(|(force, weight)| force / weight).collect()
        };
        let level = if self.is_level_known {
            0.0
        } else {
            self.forces.iter().sum::<f64>() / self.forces.len() as f64 - weighted(self).mean()
        };
        let stiff = (moduli[0] + moduli[1]) * self.stiffness * self.power;
        let stiffness =
            |approach: f64| stiff * (approach - state.touch).max(0.0).powf(self.power - 1.0);
        let excess = |at: usize, approach: f64, force: f64| {
            let measured = as_measured.forces[at] - level - force;
            approach - as_measured.approaches[at] - measured / spring
        };
        let mut next = self.clone();
        let forces: Vec<f64> = contact(self);
        for (at, approach) in next.approaches.iter_mut().enumerate() {
            let weight = 1.0 / (1.0 + stiffness(*approach) / spring);
            *approach -= weight * excess(at, *approach, forces[at]);
            next.weights[at] = 1.0 / (1.0 + stiffness(*approach) / spring);
        }
        let forces: Vec<f64> = contact(&next);
        for (at, force) in next.forces.iter_mut().enumerate() {
            let (approach, weight) = (next.approaches[at], next.weights[at]);
            let stretched = stiffness(approach) * weight * excess(at, approach, forces[at]);
            *force = as_measured.forces[at] - (1.0 - weight) * forces[at] + stretched;
        }
        next
    }

    /// The power of the approach, and the same with a memory that fades over `time`, as weighted forces of a modulus of 1 over the
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
            let weight = self.weights[i];
            (parts[0][i], parts[1][i]) = (weight * now, weight * faded);
        }
        parts
    }

    /// Relaxed modulus and that which relaxes, neither below 0, by linear least squares, and the residuals.
    pub(super) fn solid(&self, time: f64, touch: f64) -> ([f64; 2], DVector<f64>) {
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
    pub(super) fn places(&self, elastic: f64, is_free: bool) -> (Vec<f64>, f64) {
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
    pub(super) fn profile(&self, places: &[f64], contact_time: f64) -> Vec<State> {
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
            weights: thinned(&self.weights),
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
    pub(super) fn descend(&self, start: State, time: bool, touch: bool) -> Option<State> {
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
    pub(super) fn deviations(
        &self,
        state: &State,
        time: bool,
        touch: bool,
        variance: f64,
    ) -> [f64; 3] {
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
