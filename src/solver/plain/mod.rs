//! The method in one place: plain arrays, double precision, a formula beside each line.
//!
//! This is the specification. Nothing here is fused, recorded or run in parallel; the backends carry
//! out the same steps in few passes, and `tests/solver/iterates.rs` compares them with this text iterate by
//! iteration. `docs/solver.md` explains the steps, which have the same numbers there. This file is the
//! iteration; beside it stand what it evaluates (`contact`), how far a step goes (`line_search`) and
//! the convolutions (`waves`). A hardness and the rounds of mixed precision are not told here.
//!
//! Notation: g gap, h heights, u = g + h, K stiffness (a convolution), p = K*u elastic pressure,
//! sigma attraction, y = p + mean pressure + sigma(g). Laws with a wall at g = 0 are the
//! *constrained* ones; Lennard-Jones repels by itself and is *smooth*. A free boundary solves on more
//! points than the surface has: those of the pad have neither wall nor law.

mod contact;
mod line_search;
mod waves;

use contact::{Contact, dot};
use line_search::{Length, Line};

use super::contact::{Load, Outcome};
use super::problem::Problem;
use crate::kernel::Status;

/// Trials that may be lost in a row before the direction is given up.
const MOST_LOST: usize = 25;
/// Lost trials after which the plain descent takes the direction's place.
const LOST_BEFORE_DESCENT: usize = 5;
/// Factor on the trial length after a lost trial.
const SHORTEN: f64 = 0.3;
/// Stalls in a row that end a solve.
const MOST_STALLS: usize = 4;
/// Iterations at the floor of rounding that end a solve.
const MOST_AT_FLOOR: usize = 20;
/// A direction whose slope is above this share of the descent's is given up.
const LEAST_SLOPE: f64 = 1e-6;
/// Gaps below this share of the largest step are closed by a step to first touch.
const LEAST_SNAP: f64 = 1e-12;
/// The same in relative rounding errors.
const SNAP_ROUNDINGS: f64 = 8.0;
/// Step along the plain descent in careful mode, and the residual at which the mode ends.
const CAREFUL_LENGTH: f64 = 0.25;
const CAREFUL_UNTIL: f64 = 1e-3;
/// Iterations after which it ends all the same.
const CAREFUL_MOST: usize = 2000;
/// Roundings within which the parts of a trial cancel each other.
const VANISHES: f64 = 8.0;

/// What an iteration did.
pub struct Iterate<'a> {
    /// Iterations so far.
    pub iterations: usize,
    /// The gap after it, reduced, over all solved points.
    pub gap: &'a [f64],
    /// Step length t along the trial step.
    pub step: f64,
    /// Stopping measure after it.
    pub residual: f64,
}

/// A solved contact, reduced units, over all solved points.
pub struct Solution {
    /// How the solve ended.
    pub outcome: Outcome,
    /// Gap g.
    pub gap: Vec<f64>,
    /// Elastic pressure K*(g + h), without the mean pressure.
    pub pressure: Vec<f64>,
}

/// Solves a load from a gap. `careful` walks in small steps at first, as the sharp law needs.
/// `watch` sees every iterate.
pub fn solve(
    problem: &Problem,
    load: &Load,
    start: &[f64],
    tolerance: f64,
    max_iterations: usize,
    mut careful: bool,
    watch: &mut dyn FnMut(&Iterate),
) -> Solution {
    let contact = Contact::new(problem, load);
    let (mut gap, count) = (start.to_vec(), start.len());
    let mut pressure = contact.elastic_pressure(&gap);
    let mut mean_pressure = contact.mean_pressure(&gap, &pressure);
    // What conjugate gradients remember: the last direction and the residual it started from.
    let (mut direction, mut previous_residual) = (vec![0.0; count], vec![0.0; count]);
    let mut restart = true;
    // Length a of the trial along the direction.
    let mut trial_length = 1.0;
    let (mut stalls, mut residual_at_stall, mut at_floor) = (0, f64::INFINITY, 0);
    let (mut iterations, mut taken, mut last_largest) = (0, None, f64::INFINITY);

    let status = loop {
        // Step 1. The imbalance y, the free points F and the stopping measure.
        let y = contact.imbalance(&gap, &pressure, mean_pressure);
        let free = contact.free(&gap, &y);
        let measure = contact.measure(&gap, &y);
        if let Some(step) = taken.take() {
            let residual = measure.residual;
            let gap = &gap;
            watch(&Iterate {
                iterations,
                gap,
                step,
                residual,
            });
        }
        if !measure.residual.is_finite() {
            break Status::NotFinite;
        }
        if measure.residual <= tolerance {
            // Judged by the pressure carried along; now by K*(g + h) evaluated afresh.
            pressure = contact.elastic_pressure(&gap);
            mean_pressure = contact.mean_pressure(&gap, &pressure);
            let y = contact.imbalance(&gap, &pressure, mean_pressure);
            let fresh = contact.measure(&gap, &y);
            if fresh.residual <= tolerance || fresh.numerator <= contact.rounding(&gap) {
                break Status::Converged;
            }
            continue;
        }
        if measure.detached {
            break Status::PulledOff;
        }
        at_floor = if measure.numerator <= contact.rounding(&gap) {
            at_floor + 1
        } else {
            0
        };
        if at_floor >= MOST_AT_FLOOR {
            break Status::Stalled;
        }
        if iterations >= max_iterations {
            break Status::Running;
        }
        // Beyond the range of a sharp law nothing attracts: under tension there is no way back, and else
        // not if all steps still to come, a geometric series, do not lead there.
        let beyond = measure.least_gap - problem.law.range();
        let separated =
            beyond > 0.0 && (contact.may_detach || last_largest / CAREFUL_LENGTH < beyond);
        let enough = measure.residual < CAREFUL_UNTIL || iterations >= CAREFUL_MOST;
        if careful && (separated || enough) {
            (careful, restart, trial_length) = (false, true, 1.0);
        }

        // Step 2. The preconditioned residual z. `weight` is 1 on F (S2 for a smooth law) and 0 off
        // it: in its measure nothing may have a mean where the mean gap is prescribed.
        let weight = contact.weight(&gap, &free);
        let residual: Vec<f64> = (0..count).map(|i| weight[i] * y[i]).collect();
        let z = contact.precondition(&residual, &gap, &y, &free);

        // Step 3. The conjugate direction (Polak-Ribiere, never negative):
        // beta = <z, r - r_old>/<r - r_old, d>, d = -z + beta d.
        let without_mean = |values: &[f64]| contact.without_mean(values, &weight, &free);
        let (z, last) = (without_mean(&z), without_mean(&direction));
        let change: Vec<f64> = (0..count)
            .map(|i| residual[i] - previous_residual[i])
            .collect();
        let curved = dot(&direction, &change);
        let mut beta = if curved > 0.0 {
            (dot(&z, &change) / curved).max(0.0)
        } else {
            0.0
        };
        let falls = dot(&z, &residual);
        // The slope of the new direction; along it the energy must fall.
        let slope = -falls + beta * dot(&last, &residual);
        if restart || careful || !beta.is_finite() || slope >= -LEAST_SLOPE * falls {
            beta = 0.0;
        }
        restart = false;
        for i in 0..count {
            direction[i] = if free[i] { beta * last[i] - z[i] } else { 0.0 };
        }
        previous_residual = residual;
        if careful {
            trial_length = CAREFUL_LENGTH;
        }

        // Step 4. The trial step s along the direction, shortened while it does not descend.
        let mut lost = 0;
        let trial = loop {
            let trial = contact.trial(&gap, &direction, trial_length);
            let largest = trial.s.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
            if dot(&trial.s, &y) < 0.0 || (careful && largest > 0.0) {
                break Some(trial);
            }
            lost += 1;
            if lost >= MOST_LOST || largest == 0.0 {
                break None;
            }
            trial_length *= SHORTEN;
            if lost == LOST_BEFORE_DESCENT {
                direction = z.iter().map(|z| -z).collect();
            }
        };

        // Steps 5 and 6. The step length t, by the curvature <s, K s> and the law along the line.
        let mut counts = true;
        if let Some(trial) = trial {
            iterations += 1;
            last_largest = trial.s.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
            let answer = contact.stiffness_times(&trial.s);
            let elastic: Vec<f64> = pressure.iter().map(|p| p + mean_pressure).collect();
            let line = Line {
                slope: dot(&trial.s, &y),
                elastic_slope: dot(&trial.s, &elastic),
                curvature: dot(&trial.s, &answer),
                gap: &gap,
                trial: &trial,
            };
            let length = if careful {
                Length::of(1.0, 1.0)
            } else {
                contact.length(&line)
            };
            match length {
                Length::Step { t, lengthen } => {
                    // Step 7. Gap and pressure move.
                    contact.advance(&mut gap, &trial, t, careful);
                    for (p, answer) in pressure.iter_mut().zip(&answer) {
                        *p += t * answer;
                    }
                    mean_pressure = contact.mean_pressure(&gap, &pressure);
                    trial_length *= lengthen;
                    taken = Some(t);
                    continue;
                }
                Length::End(status) => break status,
                Length::None { tried } => counts = tried,
            }
        }
        if !counts {
            iterations -= 1;
        }
        // No step was found: forget the direction; several such stalls in a row end the solve.
        (restart, trial_length) = (true, 1.0);
        stalls = if measure.residual < 0.5 * residual_at_stall {
            1
        } else {
            stalls + 1
        };
        residual_at_stall = measure.residual;
        if stalls >= MOST_STALLS {
            break Status::Stalled;
        }
    };

    let pressure = contact.elastic_pressure(&gap);
    let mean_pressure = contact.mean_pressure(&gap, &pressure);
    let y = contact.imbalance(&gap, &pressure, mean_pressure);
    let end = contact.measure(&gap, &y);
    let stalled_at_floor = status == Status::Stalled && end.numerator <= contact.rounding(&gap);
    let met = matches!(status, Status::Stalled | Status::Running) && end.residual <= tolerance;
    let status = if stalled_at_floor || met {
        Status::Converged
    } else {
        status
    };
    Solution {
        outcome: Outcome {
            status,
            iterations,
            residual: end.residual,
            mean_pressure,
        },
        gap,
        pressure,
    }
}

/// A trial step.
struct Trial {
    /// s, over all solved points.
    s: Vec<f64>,
    /// Whether the wall cut it somewhere.
    cut: bool,
    /// The step at which a further point touches the wall, at least 1; infinite if none does.
    first_touch: f64,
}

impl Contact<'_> {
    /// Step 4: s = max(0, g + a d) - g; for a smooth law the change of g as its variable v moves by a d. Under
    /// a prescribed mean gap s has no mean: what is left of the gap is scaled back to it.
    fn trial(&self, gap: &[f64], direction: &[f64], length: f64) -> Trial {
        let count = gap.len();
        let wall = self.problem.law.has_wall();
        let mut cut = false;
        let mut s = vec![0.0; count];
        for i in 0..count {
            let way = length * direction[i];
            s[i] = match (self.in_domain[i], wall) {
                (false, _) => way,
                (true, true) => way.max(-gap[i]),
                (true, false) => self.gap_at(i, self.variable(i, gap[i]) + way, gap[i]) - gap[i],
            };
            cut |= wall && self.in_domain[i] && gap[i] + way < 0.0;
        }
        if self.mean_pressure.is_none() {
            let after = |i: usize| gap[i] + s[i];
            let weight: Vec<f64> = if wall {
                (0..count).map(after).collect()
            } else {
                (0..count).map(|i| self.share(i, after(i))).collect()
            };
            let total: f64 = weight.iter().sum();
            if total > 0.0 {
                let share = s.iter().sum::<f64>() / total;
                let closing = |s: &[f64]| -> f64 {
                    let open = (0..count).filter(|i| gap[*i] > 0.0);
                    open.fold(f64::NEG_INFINITY, |most, i| most.max(-s[i] / gap[i]))
                };
                let parts = closing(&s).abs() + share.abs();
                s.iter_mut().zip(weight).for_each(|(s, w)| *s -= share * w);
                // s has no mean, so that some point closes, unless nothing but rounding is left of s.
                if wall && closing(&s) <= VANISHES * f64::EPSILON * parts {
                    s.fill(0.0);
                }
            }
        }
        let touch = |i: usize| {
            if wall && self.in_domain[i] && s[i] < 0.0 {
                gap[i] / -s[i]
            } else {
                f64::INFINITY
            }
        };
        let first_touch = (0..count).map(touch).fold(f64::INFINITY, f64::min).max(1.0);
        Trial {
            s,
            cut,
            first_touch,
        }
    }

    /// Step 7: g + t s. At a wall what closes is exactly 0, rounding included.
    fn advance(&self, gap: &mut [f64], trial: &Trial, t: f64, careful: bool) {
        let largest = trial.s.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
        let snap = if t == trial.first_touch && !careful {
            LEAST_SNAP.max(SNAP_ROUNDINGS * f64::EPSILON) * largest
        } else {
            0.0
        };
        for (i, (gap, s)) in gap.iter_mut().zip(&trial.s).enumerate() {
            let moved = *gap + t * s;
            let closes = moved <= 0.0 || (*s < 0.0 && moved < snap);
            let wall = self.problem.law.has_wall() && self.in_domain[i];
            *gap = if wall && closes { 0.0 } else { moved };
        }
    }
}
