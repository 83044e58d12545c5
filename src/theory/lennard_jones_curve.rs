//! The curve of equilibria of a [`LennardJonesSphere`], with its unstable parts and turning points.

use super::error::TheoryError;
use super::lennard_jones_sphere::{Held, LennardJonesSphere, State};
use super::roots::root;

const MAX_CURVE: usize = 2000;
const LONGEST_STEP: f64 = 0.25;
const SHORTEST_STEP: f64 = 1e-6;

impl LennardJonesSphere {
    /// Equilibria from far away inwards, along both stable and unstable parts, until `until` is
    /// met; the state that meets it is the last. Neighbours are some 0.1 apart in force.
    pub fn curve(&self, until: impl Fn(&[State]) -> bool) -> Result<Vec<State>, TheoryError> {
        let unit = self.force_unit();
        let mut now = self.rigid_start(self.far())?;
        let mut states = vec![now.state.clone()];
        // Unit tangent in (approach/unit, force).
        let mut tangent = now.tangent(unit, (1.0, 0.0));
        let mut step = LONGEST_STEP;
        while states.len() < MAX_CURVE {
            let last = &now.state;
            if until(&states) {
                return Ok(states);
            }
            let held = Held {
                approach_share: tangent.0 / unit,
                force_share: tangent.1,
                sum: tangent.0 * last.approach / unit + tangent.1 * last.force + step,
            };
            let mut guess = last.clone();
            guess.approach += step * tangent.0 * unit;
            guess.gap += &now.gap_rate * (step * tangent.0 * unit);
            let next = self.solve(guess, held).map(|next| {
                let chord = (
                    (next.state.approach - last.approach) / unit,
                    next.state.force - last.force,
                );
                let new = next.tangent(unit, chord);
                let near = chord.0.hypot(chord.1) < 1.5 * step;
                let cosine = new.0 * tangent.0 + new.1 * tangent.1;
                (next, new, near && cosine > 0.7)
            });
            match next {
                // A long way or a sharp turn may be a jump to another part of the curve.
                Ok((next, new, true)) => {
                    if next.rounds <= 5 {
                        step = (1.5 * step).min(LONGEST_STEP);
                    }
                    tangent = new;
                    states.push(next.state.clone());
                    now = next;
                }
                _ if step > SHORTEST_STEP => step *= 0.5,
                Err(error) => return Err(error),
                Ok(_) => break,
            }
        }
        Err(TheoryError::NotConverged {
            what: "the curve of a Lennard-Jones sphere",
        })
    }

    /// The state of greatest tension: pull-off under load control.
    pub fn pull_off(&self) -> Result<State, TheoryError> {
        let states = self.curve(|states| match states {
            // Pull-off is beyond -0.75 for all; a soft sphere has a lesser minimum before it touches.
            [.., before, middle, last] => {
                middle.force < -0.6 && middle.force <= before.force && last.force > middle.force
            }
            _ => false,
        })?;
        self.turning_point(&states[states.len() - 3..], |tangent| tangent.1)
    }

    /// Folds of the approach, where a held approach jumps: in on the way together and off on the
    /// way apart. None for small Tabor parameters, where the curve is single-valued.
    pub fn folds(&self) -> Result<Option<(State, State)>, TheoryError> {
        let states = self.curve(|states| reaches(states, |state| state.force > 0.0))?;
        let turn = |sign: f64| {
            states.windows(3).find(|three| {
                sign * (three[1].approach - three[0].approach) > 0.0
                    && sign * (three[2].approach - three[1].approach) <= 0.0
            })
        };
        match (turn(1.0), turn(-1.0)) {
            (Some(jump_in), Some(jump_off)) => Ok(Some((
                self.turning_point(jump_in, |tangent| tangent.0)?,
                self.turning_point(jump_off, |tangent| tangent.0)?,
            ))),
            _ => Ok(None),
        }
    }

    /// The state between three neighbours where a component of the curve's tangent, in
    /// (approach, force), changes sign.
    fn turning_point(
        &self,
        three: &[State],
        component: impl Fn((f64, f64)) -> f64,
    ) -> Result<State, TheoryError> {
        let failed = TheoryError::NotConverged {
            what: "a turning point",
        };
        let [first, middle, last] = three else {
            return Err(failed);
        };
        let unit = self.force_unit();
        let chord = (
            (last.approach - first.approach) / unit,
            last.force - first.force,
        );
        let length = chord.0.hypot(chord.1);
        let direction = (chord.0 / length, chord.1 / length);
        let along = |state: &State| direction.0 * state.approach / unit + direction.1 * state.force;
        // States by their place along the chord, from a parabola through the three.
        let places = [first, middle, last].map(along);
        let at = |place: f64| {
            let weight = |i: usize, j: usize, k: usize| {
                (place - places[j]) * (place - places[k])
                    / ((places[i] - places[j]) * (places[i] - places[k]))
            };
            let (a, b, c) = (weight(0, 1, 2), weight(1, 2, 0), weight(2, 0, 1));
            let guess = State {
                approach: a * first.approach + b * middle.approach + c * last.approach,
                force: a * first.force + b * middle.force + c * last.force,
                gap: &first.gap * a + &middle.gap * b + &last.gap * c,
            };
            let held = Held {
                approach_share: direction.0 / unit,
                force_share: direction.1,
                sum: place,
            };
            let solved = self.solve(guess, held).ok()?;
            Some((component(solved.tangent(unit, direction)), solved.state))
        };
        let slope = |place: f64| at(place).map_or(f64::NAN, |(slope, _)| slope);
        let place = root("a turning point", slope, places[0], places[2], 1e-8)?;
        at(place).map(|(_, state)| state).ok_or(failed)
    }
}

/// Whether the last of the states meets a condition.
fn reaches(states: &[State], condition: impl Fn(&State) -> bool) -> bool {
    states.last().is_some_and(condition)
}
