//! `steps = "auto"`: time steps of a path on a viscoelastic solid.
//!
//! A step assumes that the displacement is linear in time and is otherwise exact. For a contact of
//! constant shape the response between two kinks of the path is known beforehand: after a kink it
//! is a sum of exponentials, over the retardation times under a prescribed load and over the
//! relaxation times under a prescribed position. A spring between position and body, and an attraction, lie between the two: the
//! displacement then creeps as that of a solid whose branches lie beside a stiffer spring than its own, which how much depends on
//! the contact (`E_inf + k/c` for a spring `k` and a contact that takes `c E`). Steps are straight enough for all of these.
//! Each ramp is halved recursively until every step is straight enough, so steps are short after a
//! kink and grow with the time since it.
//!
//! If the response lies off its chord by `gap` in the middle of a step, and by two thirds of that
//! on average, the springs are off by as much. Under a load the springs move the displacement in
//! turn; the total is at most `J(T)/J(0) - 1` times that (from the resolvent of the creep
//! compliance J over the path's time T).
//!
//! A contact that changes its shape also bends the response within a ramp; it is taken as a
//! parabola that lies off its chord by a quarter of the ramp's change.

use super::loading::MOST_STEPS;
use super::{Control, LoadingScene, Scene, SolidScene};

/// Default relative error of a path in time.
pub const DEFAULT_TOLERANCE: f64 = 1e-3;

/// Rates that differ by less than this share of the path's greatest value over the step's time are
/// equal: the values were rounded.
const SAME_RATE: f64 = 1e-12;

/// Mean over its middle of a parabola that vanishes at both ends.
const MEAN_OF_A_BEND: f64 = 2.0 / 3.0;

/// Ratio of one stiffness beside the branches to the next: retardation times differ by no more.
const NEXT_STIFFNESS: f64 = 2.0;

/// Halvings of the interval between two relaxation times, enough for every bit of a double.
const BISECTIONS: usize = 200;

/// An exponentially decaying part of the response.
#[derive(Clone, Copy, Debug)]
struct Mode {
    /// Its time constant, s.
    time: f64,
    /// Its share: of the final response under a prescribed load, of the initial one under a
    /// prescribed position.
    share: f64,
    /// Its memory of the path so far.
    memory: f64,
}

/// A ramp between two values, or a hold.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg {
    /// Target value.
    pub to: f64,
    /// Duration, s.
    pub duration: f64,
}

impl Leg {
    /// Values at the ends of the steps of this leg, and their durations, s.
    pub fn steps(self, from: f64, shares: Vec<f64>) -> impl Iterator<Item = (f64, f64)> {
        let mut end = 0.0;
        shares.into_iter().map(move |share| {
            end += share;
            // Powers of one half add up to 1 without rounding.
            let value = if end < 1.0 {
                from + (self.to - from) * end
            } else {
                self.to
            };
            (value, self.duration * share)
        })
    }
}

impl LoadingScene {
    /// Intervals of constant rate with their numbers of steps; empty if the path takes no time.
    #[doc(hidden)]
    pub fn stretches(&self) -> Vec<Stretch> {
        let Some(durations) = &self.durations else {
            return Vec::new();
        };
        let scale = self.path.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let mut found: Vec<Stretch> = Vec::new();
        let mut change = 0.0;
        for (pair, duration) in self.path.windows(2).zip(&durations[1..]) {
            let step = pair[1] - pair[0];
            if let Some(last) = found.last_mut() {
                let time = last.duration + duration;
                let continues = if time > 0.0 {
                    let off = (step * last.duration - change * duration).abs();
                    off <= SAME_RATE * scale * time
                } else {
                    step * change >= 0.0
                };
                if continues {
                    *last = Stretch {
                        to: pair[1],
                        duration: time,
                        steps: last.steps + 1,
                    };
                    change += step;
                    continue;
                }
            }
            change = step;
            found.push(Stretch {
                to: pair[1],
                duration: *duration,
                steps: 1,
            });
        }
        found
    }
}

/// An interval of a path at constant rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Target value, in the unit of the path.
    pub to: f64,
    /// Duration, s.
    pub duration: f64,
    /// Number of steps.
    pub steps: usize,
}

impl Scene {
    /// The path with `steps = "auto"` on every ramp, for a relative error in time of `tolerance`,
    /// whatever the steps of this scene. `None` for an elastic solid, and if there would be more
    /// steps than a path may have.
    pub fn auto_steps(&self, tolerance: f64) -> Option<LoadingScene> {
        let loading = &self.loading;
        if self.solid.relaxation.is_empty() || loading.durations.is_none() {
            return None;
        }
        let stretches = loading.stretches().into_iter();
        let legs: Vec<Leg> = stretches
            .map(|stretch| Leg {
                to: stretch.to,
                duration: stretch.duration,
            })
            .collect();
        let start = *loading.path.first()?;
        let creeps = self.adhesion.is_some() || loading.spring.is_some();
        let mut cutter = Cutter::new(
            &self.solid,
            loading.control,
            creeps,
            start,
            &legs,
            tolerance,
        );
        let mut path = vec![start];
        let mut durations = vec![0.0];
        for leg in legs {
            let from = path[path.len() - 1];
            let shares = cutter.cut(&leg, MOST_STEPS.saturating_sub(path.len()))?;
            let (values, times): (Vec<f64>, Vec<f64>) = leg.steps(from, shares).unzip();
            path.extend(values);
            durations.extend(times);
        }
        Some(LoadingScene {
            path,
            durations: Some(durations),
            ..loading.clone()
        })
    }
}

/// Divides the legs of one path into steps.
#[derive(Debug)]
pub(super) struct Cutter {
    responses: Vec<Response>,
    tolerance: f64,
}

impl Cutter {
    /// A cutter for the path of a solid from `start` over all its legs, to a relative error of
    /// `tolerance`. `creeps` is true if a load acts under a prescribed position too: an attraction or a spring.
    pub fn new(
        solid: &SolidScene,
        control: Control,
        creeps: bool,
        start: f64,
        legs: &[Leg],
        tolerance: f64,
    ) -> Cutter {
        let mut responses = Vec::new();
        let mut add = |modes, creeps| {
            responses.push(Response::new(modes, control, creeps, start, legs));
        };
        if control.is_load() || creeps {
            add(retardation(solid, solid.contact_modulus), true);
        }
        if !control.is_load() {
            add(relaxation(solid), false);
        }
        if creeps && !control.is_load() {
            let branches = solid.relaxation.iter().map(|branch| branch.modulus);
            let at_once = solid.contact_modulus + branches.sum::<f64>();
            let mut stiffness = NEXT_STIFFNESS * solid.contact_modulus;
            while stiffness < NEXT_STIFFNESS * at_once {
                add(retardation(solid, stiffness), true);
                stiffness *= NEXT_STIFFNESS;
            }
        }
        Cutter {
            responses,
            tolerance,
        }
    }

    /// Passes over a leg without dividing it.
    pub fn go(&mut self, leg: &Leg) {
        self.responses
            .iter_mut()
            .for_each(|response| response.go(leg));
    }

    /// Divides a leg into steps: the share of each step in its duration, powers of one half that
    /// add up to 1. `None` if there are more than `most`.
    pub fn cut(&mut self, leg: &Leg, most: usize) -> Option<Vec<f64>> {
        let mut shares = Vec::new();
        // Start and length of the parts still to be divided, as shares of the leg; the next one is
        // last.
        let mut open = vec![(0.0, 1.0)];
        while let Some((begin, length)) = open.pop() {
            let is_bent = |response: &Response| response.error(leg, begin, length) > self.tolerance;
            if leg.duration > 0.0 && self.responses.iter().any(is_bent) {
                let half = 0.5 * length;
                open.push((begin + half, half));
                open.push((begin, half));
                // Each of these becomes at least one step.
                if shares.len() + open.len() > most {
                    return None;
                }
            } else {
                shares.push(length);
            }
        }
        self.go(leg);
        Some(shares)
    }
}

/// One way in which a contact may answer.
#[derive(Debug)]
struct Response {
    modes: Vec<Mode>,
    /// Greatest response of the path, in the unit of the values.
    scale: f64,
    /// Upper bound on the error of the response, relative to the deviation from its chord.
    gain: f64,
    value: f64,
}

impl Response {
    /// That of these modes to a path from `start` over all its legs; `creeps` where they are of a displacement.
    fn new(modes: Vec<Mode>, control: Control, creeps: bool, start: f64, legs: &[Leg]) -> Response {
        // The initial indentation under a mean gap is unknown: the memory is bounded by the whole
        // change of the path, and the error is compared with no more than that change.
        let (first, least) = match control {
            Control::MeanGap => {
                let ends = legs.iter().map(|leg| leg.to);
                let moved = ends.fold(0.0, |most: f64, to| most.max((to - start).abs()));
                // A decreasing gap is an increasing indentation.
                if moved > 0.0 {
                    (-moved, 0.0)
                } else {
                    (-start.abs(), -start.abs())
                }
            }
            _ => (start, start),
        };
        let total: f64 = legs.iter().map(|leg| leg.duration).sum();
        let gain = if creeps {
            (compliance(&modes, total) / compliance(&modes, 0.0) - 1.0).max(1.0)
        } else {
            1.0
        };
        let mut response = Response {
            modes,
            scale: 0.0,
            gain,
            value: start,
        };
        for mode in &mut response.modes {
            mode.memory = least;
        }
        let mut level = least;
        response.scale = response.answer(level, creeps);
        for leg in legs {
            level += leg.to - response.value;
            response.go(leg);
            response.scale = response.scale.max(response.answer(level, creeps));
        }
        for mode in &mut response.modes {
            mode.memory = first;
        }
        response.value = start;
        response
    }

    /// The response to a prescribed value: displacement times relaxed modulus, or force over
    /// instantaneous modulus.
    fn answer(&self, level: f64, creeps: bool) -> f64 {
        let shares: f64 = self.modes.iter().map(|mode| mode.share).sum();
        let fading: f64 = self.modes.iter().map(|mode| mode.share * mode.memory).sum();
        if creeps {
            (level - fading).abs()
        } else {
            ((1.0 - shares) * level + fading).abs()
        }
    }

    /// Passes over a leg.
    fn go(&mut self, leg: &Leg) {
        let change = leg.to - self.value;
        for mode in &mut self.modes {
            let ratio = leg.duration / mode.time;
            // A leg of no duration is a jump.
            let kept = if ratio > 0.0 {
                -(-ratio).exp_m1() / ratio
            } else {
                1.0
            };
            mode.memory = mode.memory * (-ratio).exp() + change * kept;
        }
        self.value = leg.to;
    }

    /// Relative error of one step over a part of a leg.
    fn error(&self, leg: &Leg, begin: f64, length: f64) -> f64 {
        let change = leg.to - self.value;
        let [begin_time, step] = [begin, length].map(|share| share * leg.duration);
        let fading: f64 = self
            .modes
            .iter()
            .map(|mode| {
                let bent = mode.memory - change * mode.time / leg.duration;
                let half = (-0.5 * step / mode.time).exp_m1();
                0.5 * mode.share * bent.abs() * (-begin_time / mode.time).exp() * half * half
            })
            .sum();
        let shape = 0.25 * change.abs() * length * length;
        if self.scale > 0.0 {
            self.gain * MEAN_OF_A_BEND * (fading + shape) / self.scale
        } else {
            0.0
        }
    }
}

/// Creep compliance after a time, relative to its final value.
fn compliance(modes: &[Mode], time: f64) -> f64 {
    let missing = |mode: &Mode| mode.share * (-time / mode.time).exp();
    1.0 - modes.iter().map(missing).sum::<f64>()
}

/// Decay of the force under a constant displacement.
fn relaxation(solid: &SolidScene) -> Vec<Mode> {
    let branches = solid.relaxation.iter();
    let at_once = branches
        .clone()
        .fold(solid.contact_modulus, |sum, branch| sum + branch.modulus);
    let mode = |branch: &super::RelaxationScene| Mode {
        time: branch.time,
        share: branch.modulus / at_once,
        memory: 0.0,
    };
    branches.map(mode).collect()
}

/// Creep of the displacement under a constant load: one retardation time above each relaxation time
/// and below the next, where `E_inf = sum E_k tau_k/(theta - tau_k)`; `relaxed` stands for E_inf, Pa.
fn retardation(solid: &SolidScene, relaxed: f64) -> Vec<Mode> {
    let mut branches: Vec<(f64, f64)> = Vec::new();
    for branch in &solid.relaxation {
        match branches.iter_mut().find(|(time, _)| *time == branch.time) {
            Some((_, modulus)) => *modulus += branch.modulus,
            None => branches.push((branch.time, branch.modulus)),
        }
    }
    branches.sort_by(|one, other| one.0.total_cmp(&other.0));
    let all: f64 = branches.iter().map(|(_, modulus)| modulus).sum();
    let slowest = branches.last().map_or(0.0, |(time, _)| *time);
    // No root lies above the retardation time of a solid whose branches are all as slow as the
    // slowest.
    let bound = slowest * (1.0 + all / relaxed);
    let pull = |theta: f64| -> f64 {
        branches
            .iter()
            .map(|(tau, modulus)| modulus * tau / (theta - tau))
            .sum()
    };
    let mut modes = Vec::with_capacity(branches.len());
    for (index, (tau, _)) in branches.iter().enumerate() {
        let mut low = *tau;
        let mut high = branches.get(index + 1).map_or(bound, |(next, _)| *next);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if pull(middle) > relaxed {
                low = middle;
            } else {
                high = middle;
            }
        }
        // The upper end is not a pole, except for times with no double between them.
        let theta = high;
        let steepness: f64 = branches
            .iter()
            .map(|(tau, modulus)| modulus * tau / (theta - tau).powi(2))
            .sum();
        let share = relaxed / (theta * steepness);
        if share.is_finite() {
            modes.push(Mode {
                time: theta,
                share,
                memory: 0.0,
            });
        }
    }
    modes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::RelaxationScene;

    fn solid(branches: &[(f64, f64)]) -> SolidScene {
        SolidScene {
            contact_modulus: 0.1,
            poisson_ratio: None,
            layer: None,
            hardness: None,
            relaxation: branches
                .iter()
                .map(|&(modulus, time)| RelaxationScene { modulus, time })
                .collect(),
        }
    }

    /// One branch: the retardation time is `tau E_0/E_inf`, and `1 - E_inf/E_0` creeps.
    #[test]
    fn one_branch_creeps_in_its_own_time() {
        let modes = retardation(&solid(&[(0.5, 1.0), (0.4, 1.0)]), 0.1);
        assert_eq!(modes.len(), 1);
        assert!((modes[0].time - 10.0).abs() < 1e-12, "{modes:?}");
        assert!((modes[0].share - 0.9).abs() < 1e-12, "{modes:?}");
    }

    /// The instantaneous response is the sum of all springs: the shares leave `E_inf/E_0`.
    #[test]
    fn many_branches_leave_the_answer_at_once() {
        let many = solid(&[(0.3, 1.0), (0.2, 30.0), (0.4, 0.01), (5.0, 1.001)]);
        let modes = retardation(&many, 0.1);
        let left = compliance(&modes, 0.0);
        assert!((left - 0.1 / 6.0).abs() < 1e-12, "{left}");
        assert!(modes.iter().all(|mode| mode.share > 0.0));
    }

    #[test]
    fn steps_grow_away_from_a_kink_and_add_up() {
        let hold = Leg {
            to: 1.0,
            duration: 1e4,
        };
        let solid = solid(&[(0.9, 1.0)]);
        let cut = |tolerance: f64, most: usize| {
            Cutter::new(&solid, Control::Force, false, 1.0, &[hold], tolerance).cut(&hold, most)
        };
        let steps = cut(1e-3, 1000).expect("few enough");
        assert_eq!(steps.iter().sum::<f64>(), 1.0);
        assert!(steps.windows(2).all(|pair| pair[0] <= pair[1]), "{steps:?}");
        let finer = cut(1e-5, 10_000).expect("few enough");
        // Second order: ten times as many steps for a hundredth of the error, up to the rounding to
        // halves.
        let ratio = finer.len() as f64 / steps.len() as f64;
        assert!((5.0..20.0).contains(&ratio), "{ratio}");
        assert_eq!(cut(1e-5, finer.len()), Some(finer.clone()));
        assert_eq!(cut(1e-5, finer.len() - 1), None);
    }
}
