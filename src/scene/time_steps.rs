//! `steps = "auto"`: how finely a path is cut for a solid that relaxes.
//!
//! A step takes its displacement as linear in time and is exact but for that. What the solid does
//! between is known beforehand for a contact that keeps its shape: after each kink of the path its
//! answer bends as a sum of exponentials, over the retardation times where a load creeps and the
//! relaxation times where the surface is held. An attraction is a load, whatever is held. A ramp is halved, and its halves again, until every
//! step is straight enough; so the steps are short after a kink and grow with the time from it.
//!
//! A step whose answer stands off its chord by `gap` in the middle, two thirds of that on average,
//! moves the springs by as much, and under a load they move the displacement in turn, all in all by
//! up to `J(T)/J(0) - 1` times that (the resolvent of the creep compliance J over the path's time T).
//!
//! A contact that changes its shape bends over a ramp too; it is taken as bent as a parabola that
//! stands off its chord by a quarter of the ramp's change.

use super::loading::MOST_STEPS;
use super::{Control, LoadingScene, Scene, SolidScene};

/// Error of a path in time where none is asked for, relative.
pub const DEFAULT_TOLERANCE: f64 = 1e-3;

/// Rates of a path that differ by less, of its greatest value over the time of a step, are one rate:
/// the values were rounded.
const SAME_RATE: f64 = 1e-12;

/// Mean over its middle of a parabola that vanishes at both ends.
const MEAN_OF_A_BEND: f64 = 2.0 / 3.0;

/// Halvings of an interval between two relaxation times: every bit of a double.
const BISECTIONS: usize = 200;

/// A part of the answer that fades.
#[derive(Clone, Copy, Debug)]
struct Mode {
    /// Its time, s.
    time: f64,
    /// Its share: of the last answer under a held load, of the first where the surface is held.
    share: f64,
    /// What it remembers of the path so far.
    memory: f64,
}

/// A ramp between two values, or a hold.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg {
    /// Where it goes.
    pub to: f64,
    /// How long it takes, s.
    pub duration: f64,
}

impl Leg {
    /// Values at the ends of the steps that cut this leg, and how long each takes, s.
    pub fn steps(self, from: f64, shares: Vec<f64>) -> impl Iterator<Item = (f64, f64)> {
        let mut end = 0.0;
        shares.into_iter().map(move |share| {
            end += share;
            // Halves add up to 1 without rounding.
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
    /// Stretches of one rate, with how many steps each has; none where the path takes no time.
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
                let goes_on = if time > 0.0 {
                    let off = (step * last.duration - change * duration).abs();
                    off <= SAME_RATE * scale * time
                } else {
                    step * change >= 0.0
                };
                if goes_on {
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

/// A part of a path at one rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Where it goes, in the unit of the path.
    pub to: f64,
    /// How long it takes, s.
    pub duration: f64,
    /// How many steps it has.
    pub steps: usize,
}

impl Scene {
    /// The path as `steps = "auto"` cuts it on every ramp for a relative error of `tolerance` in time,
    /// whatever the steps of this scene; `None` for a solid that does not relax, and where there
    /// would be more steps than a path may have.
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

/// Cuts the legs of one path.
#[derive(Debug)]
pub(super) struct Cutter {
    modes: Vec<Mode>,
    /// Greatest answer of the path, in the unit of the values.
    scale: f64,
    /// What a bend does to the answer at most, relative to the bend.
    gain: f64,
    tolerance: f64,
    value: f64,
}

impl Cutter {
    /// For a path of a solid from `start` over all its legs, to a relative error of `tolerance`;
    /// `creeps` where a load acts, be it an attraction or a spring's.
    pub fn new(
        solid: &SolidScene,
        control: Control,
        creeps: bool,
        start: f64,
        legs: &[Leg],
        tolerance: f64,
    ) -> Cutter {
        let creeps = creeps || matches!(control, Control::Pressure | Control::Force);
        let modes = match creeps {
            true => retardation(solid),
            false => relaxation(solid),
        };
        // How far a mean gap dents the surface at first is not known: what is remembered may be as much
        // as the path moves it, what errors are compared with may be no more than that.
        let (first, least) = match control {
            Control::MeanGap => {
                let ends = legs.iter().map(|leg| leg.to);
                let moved = ends.fold(0.0, |most: f64, to| most.max((to - start).abs()));
                // A gap that shrinks dents.
                if moved > 0.0 {
                    (-moved, 0.0)
                } else {
                    (-start.abs(), -start.abs())
                }
            }
            _ => (start, start),
        };
        let total: f64 = legs.iter().map(|leg| leg.duration).sum();
        let gain = match creeps {
            true => (compliance(&modes, total) / compliance(&modes, 0.0) - 1.0).max(1.0),
            false => 1.0,
        };
        let mut cutter = Cutter {
            modes,
            scale: 0.0,
            gain,
            tolerance,
            value: start,
        };
        for mode in &mut cutter.modes {
            mode.memory = least;
        }
        let mut level = least;
        cutter.scale = cutter.answer(level, creeps);
        for leg in legs {
            level += leg.to - cutter.value;
            cutter.go(leg);
            cutter.scale = cutter.scale.max(cutter.answer(level, creeps));
        }
        for mode in &mut cutter.modes {
            mode.memory = first;
        }
        cutter.value = start;
        cutter
    }

    /// The answer at a level of what is prescribed: displacement times relaxed modulus, or force
    /// over the modulus at once.
    fn answer(&self, level: f64, creeps: bool) -> f64 {
        let shares: f64 = self.modes.iter().map(|mode| mode.share).sum();
        let fading: f64 = self.modes.iter().map(|mode| mode.share * mode.memory).sum();
        match creeps {
            true => (level - fading).abs(),
            false => ((1.0 - shares) * level + fading).abs(),
        }
    }

    /// Goes over a leg without cutting it.
    pub fn go(&mut self, leg: &Leg) {
        let change = leg.to - self.value;
        for mode in &mut self.modes {
            let ratio = leg.duration / mode.time;
            // A leg in no time is a jump.
            let kept = if ratio > 0.0 {
                -(-ratio).exp_m1() / ratio
            } else {
                1.0
            };
            mode.memory = mode.memory * (-ratio).exp() + change * kept;
        }
        self.value = leg.to;
    }

    /// Cuts a leg and goes over it: the share of each step in its duration, powers of one half
    /// that add up to 1. `None` if there are more than `most`.
    pub fn cut(&mut self, leg: &Leg, most: usize) -> Option<Vec<f64>> {
        let mut shares = Vec::new();
        // Begin and length of what is still to be cut, as shares of the leg; the next one last.
        let mut open = vec![(0.0, 1.0)];
        while let Some((begin, length)) = open.pop() {
            if leg.duration > 0.0 && self.error(leg, begin, length) > self.tolerance {
                let half = 0.5 * length;
                open.push((begin + half, half));
                open.push((begin, half));
                // Each of these is one step at least.
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

    /// What one step over a part of a leg brings in, relative.
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

/// Creep compliance after a time, over that in the end.
fn compliance(modes: &[Mode], time: f64) -> f64 {
    let missing = |mode: &Mode| mode.share * (-time / mode.time).exp();
    1.0 - modes.iter().map(missing).sum::<f64>()
}

/// How the force under a held displacement fades.
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

/// How the displacement under a held load creeps: one retardation time above each relaxation time
/// and below the next, where `E_inf = sum E_k tau_k/(theta - tau_k)`.
fn retardation(solid: &SolidScene) -> Vec<Mode> {
    let relaxed = solid.contact_modulus;
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
    // No root lies above the time that all branches would have were they as slow as the slowest.
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
        // The upper end is no pole, but for times that no double lies between.
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

    /// One branch: the time of creep is `tau E_0/E_inf`, and `1 - E_inf/E_0` creeps.
    #[test]
    fn one_branch_creeps_in_its_own_time() {
        let modes = retardation(&solid(&[(0.5, 1.0), (0.4, 1.0)]));
        assert_eq!(modes.len(), 1);
        assert!((modes[0].time - 10.0).abs() < 1e-12, "{modes:?}");
        assert!((modes[0].share - 0.9).abs() < 1e-12, "{modes:?}");
    }

    /// At once the solid answers with the sum of its springs: the shares leave `E_inf/E_0`.
    #[test]
    fn many_branches_leave_the_answer_at_once() {
        let many = solid(&[(0.3, 1.0), (0.2, 30.0), (0.4, 0.01), (5.0, 1.001)]);
        let modes = retardation(&many);
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
        // Second order: ten times as many for a hundredth of the error, as far as halves allow.
        let ratio = finer.len() as f64 / steps.len() as f64;
        assert!((5.0..20.0).contains(&ratio), "{ratio}");
        assert_eq!(cut(1e-5, finer.len()), Some(finer.clone()));
        assert_eq!(cut(1e-5, finer.len() - 1), None);
    }
}
