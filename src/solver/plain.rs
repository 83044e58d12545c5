//! The method in one text: plain arrays, double precision, the formula beside the line.
//!
//! This is the specification. Nothing is fused, recorded or run in parallel; the backends carry out the
//! same steps in fewer passes, and `tests/solver/iterates.rs` compares them with this text iterate by
//! iterate. The steps have the numbers that `docs/solver.md` gives them. `plain_setup.rs` holds what is no
//! step: arrays, transforms, the law at a point. The constants in capitals are in `kernel/scalar.rs`. A
//! hardness and the rounds of mixed precision are left out.
//!
//! g gap, h heights, K stiffness (a convolution), p = K*(g + h) elastic pressure, pbar mean pressure,
//! sigma(g) attraction, V(g) its energy, y = p + pbar + sigma(g) imbalance, F free points, r residual,
//! z = M r, d direction, s trial step, t its length. Laws with a wall need g >= 0; Lennard-Jones, the
//! smooth law, repels by itself: it is steep there, so that the iteration works in a variable v(g) in which
//! it is not, dg = S dv; at a wall v = g and S = 1. The points of the pad, which a free boundary adds, have
//! neither wall nor law.

use super::load::{Load, Outcome};
use super::multilevel::{EXACT_UNTIL, sticks};
use super::plain_setup::{Contact, choose, dot, each, largest, least, most, norm, sum};
use super::problem::Problem;
use crate::kernel::Status;
use crate::kernel::scalar::*;

/// Solves a load from a gap over all solved points, reduced units; returns how it ended and the gap.
/// `careful` begins with small steps, as the sharp law needs. `watch` sees the gap after each iteration,
/// its step length t, and the residual.
pub fn solve(
    problem: &Problem,
    load: &Load,
    start: &[f64],
    tolerance: f64,
    max_iterations: usize,
    mut careful: bool,
    watch: &mut dyn FnMut(&[f64], f64, f64),
) -> (Outcome, Vec<f64>) {
    let contact = Contact::new(problem, load);
    let n = start.len();
    let mut now = contact.fresh_state(start.to_vec());
    let (mut direction, mut previous_residual) = (vec![0.0; n], vec![0.0; n]);
    let (mut restart, mut trial_length, mut largest_move) = (true, 1.0, f64::INFINITY);
    let (mut iterations, mut at_floor, mut stalls) = (0, 0, 0);
    let mut residual_at_stall = f64::INFINITY;
    let mut exact = sticks(problem) && now.residual >= EXACT_UNTIL;

    let status = loop {
        // Step 1. Is the present state the solution?
        if now.residual <= tolerance {
            // p was carried along; what counts is K*(g + h).
            now = contact.fresh_state(now.gap);
            if now.residual <= tolerance || now.at_floor {
                break Status::Converged;
            }
            continue;
        }
        at_floor = choose(now.at_floor, at_floor + 1, 0);
        if !now.residual.is_finite() {
            break Status::NotFinite;
        } else if now.detached {
            break Status::PulledOff;
        } else if at_floor >= AT_FLOOR {
            break Status::Stalled;
        } else if iterations >= max_iterations {
            break Status::Running;
        }
        // Careful mode ends near the solution, and out of the law's reach if nothing leads back: under
        // tension, or where all steps to come, a geometric series, are shorter than the way.
        let way = now.least_gap - problem.law.range();
        let returns = !contact.params.may_detach && largest_move / CAREFUL_LENGTH >= way;
        let near = now.residual < CAREFUL_UNTIL || iterations >= CAREFUL_MOST as usize;
        if careful && (near || (way > 0.0 && !returns)) {
            (careful, restart, trial_length) = (false, true, 1.0);
        }

        // Step 2. The residual r = S y on F, and z = M r.
        let residual = each(n, |i| now.weight[i] * now.y[i]);
        let z = contact.project(&contact.precondition(&residual, &now, exact), &now);

        // Step 3. beta = max(0, <z, r - r_old> / <d_old, r - r_old>) (Polak-Ribiere); the direction
        // d = -z + beta d_old, or -z if that would not descend.
        let old = contact.project(&direction, &now);
        let change = each(n, |i| residual[i] - previous_residual[i]);
        let curved = dot(&direction, &change);
        let mut beta = (dot(&z, &change) / curved).max(0.0);
        let slope = -dot(&z, &residual) + beta * dot(&old, &residual);
        let descends = slope < -SLOPE_SHARE * dot(&z, &residual);
        if restart || careful || curved <= 0.0 || !beta.is_finite() || !descends {
            beta = 0.0;
        }
        direction = each(n, |i| beta * old[i] - z[i]);
        (restart, previous_residual) = (false, residual);

        // Step 4. The trial step s along a d, with a shortened until s descends: <s, y> < 0.
        trial_length = choose(careful, CAREFUL_LENGTH, trial_length);
        let mut lost = 0;
        let trial = loop {
            let trial = contact.trial(&now.gap, &direction, trial_length);
            largest_move = largest(&trial.s);
            if dot(&trial.s, &now.y) < 0.0 || (careful && largest_move > 0.0) {
                break Some(trial);
            }
            lost += 1;
            if lost >= LOST_TRIALS || largest_move == 0.0 {
                break None;
            }
            trial_length *= SHORTEN;
            if lost == LOST_BEFORE_DESCENT {
                direction = each(n, |i| -z[i]);
            }
        };

        // Steps 5 and 6. The step length t.
        if let Some(trial) = trial {
            match contact.step_length(&now, &trial, careful) {
                StepLength::Take { t, lengthen } => {
                    // Step 7. g and p move; a is adapted.
                    let gap = contact.advance(&now.gap, &trial, t, careful);
                    let pressure = each(n, |i| now.pressure[i] + t * trial.response[i]);
                    now = contact.state(gap, pressure);
                    trial_length *= lengthen;
                    iterations += 1;
                    exact &= now.residual >= EXACT_UNTIL;
                    watch(&now.gap, t, now.residual);
                    continue;
                }
                StepLength::End(status) => break status,
                StepLength::Lost => {}
            }
        }
        // No step was found: begin again along -z. Several such stalls without progress end the solve.
        (restart, trial_length) = (true, 1.0);
        stalls = choose(now.residual < 0.5 * residual_at_stall, 1, stalls + 1);
        residual_at_stall = now.residual;
        if stalls >= STALLS {
            break Status::Stalled;
        }
    };

    let end = contact.fresh_state(now.gap);
    let status = match status {
        Status::Stalled if end.at_floor => Status::Converged,
        Status::Stalled | Status::Running if end.residual <= tolerance => Status::Converged,
        status => status,
    };
    let outcome = Outcome::new(status, iterations, end.residual, end.mean_pressure);
    (outcome, end.gap)
}

/// A gap with its elastic pressure, and what follows from them.
pub(super) struct State {
    gap: Vec<f64>,
    pressure: Vec<f64>,
    mean_pressure: f64,
    y: Vec<f64>,
    /// S on F, 0 elsewhere.
    weight: Vec<f64>,
    residual: f64,
    /// Whether rounding alone is left of the residual.
    at_floor: bool,
    least_gap: f64,
    /// Whether surfaces under tension have left each other.
    detached: bool,
}

/// A trial step.
struct Trial {
    s: Vec<f64>,
    /// K*s.
    response: Vec<f64>,
    /// Whether the wall cut it.
    cut: bool,
    /// Step length at which it touches a further point, at least 1.
    first_touch: f64,
}

/// How far a trial step is taken.
enum StepLength {
    /// By t; the length a of the next trial is multiplied by `lengthen`.
    Take { t: f64, lengthen: f64 },
    /// Nowhere.
    Lost,
    /// The solve is over.
    End(Status),
}

impl Contact<'_> {
    /// The state of a gap, with p = K*(g + h).
    fn fresh_state(&self, gap: Vec<f64>) -> State {
        let u = each(gap.len(), |i| gap[i] + self.heights[i]);
        self.state(gap, self.stiffness_times(&u))
    }

    /// Step 1: pbar, y, F and the residual.
    fn state(&self, gap: Vec<f64>, pressure: Vec<f64>) -> State {
        let n = gap.len();
        let sigma = each(n, |i| self.traction(i, gap[i]));
        // Under a prescribed mean gap pbar keeps <w, y> = 0, the slope of the energy as the mean changes.
        let mean_pressure = self.mean_pressure.unwrap_or_else(|| {
            let w = self.mean_gap_weight(&gap);
            let y = each(n, |i| pressure[i] + sigma[i]);
            choose(sum(&w) > 0.0, -dot(&w, &y) / sum(&w), -least(&y))
        });
        // y = p + pbar + sigma. F: g > 0 or y < 0, and everywhere without a wall.
        let y = each(n, |i| pressure[i] + mean_pressure + sigma[i]);
        let free = |i: usize| !self.wall[i] || gap[i] > 0.0 || y[i] < 0.0;
        let weight = each(n, |i| choose(free(i), self.share(i, gap[i]), 0.0));

        // |min(y, g K_max)| over |reaction of the wall, sigma|; |y| without a wall.
        let stiffness_max = self.params.stiffness_max;
        let off = |i: usize| choose(self.wall[i], y[i].min(gap[i] * stiffness_max), y[i]);
        let closed = |i: usize| self.wall[i] && gap[i] <= 0.0;
        let reaction = each(n, |i| choose(closed(i), y[i].max(0.0), 0.0));
        let violation = norm(&each(n, off));
        let pressures = norm(&reaction).hypot(norm(&sigma));
        let surface = self.problem.surface_part(&gap);
        let beside = norm(&surface).max(self.params.heights_norm);
        let rounding = self.params.epsilon * stiffness_max * beside;

        let least_gap = least(&surface);
        let reach = DETACHED_RANGES * self.problem.law.range();
        let detached = self.params.may_detach && least_gap > reach;
        // Flat surfaces may have no pressure: 0/0 counts as 0, and so does what rounding leaves of it.
        let floor = self.params.pressure_floor;
        let nothing = floor == 0.0 && violation.max(pressures) <= rounding && !detached;
        let residual = choose(violation == 0.0, 0.0, violation / pressures.max(floor));
        State {
            gap,
            pressure,
            mean_pressure,
            y,
            weight,
            residual: choose(nothing, 0.0, residual),
            at_floor: violation <= rounding,
            least_gap,
            detached,
        }
    }

    /// Step 2: z = M r. Where an attraction falls with the gap at a wall the levels sweep twice, z = M (r + a D M r): two terms
    /// of the inverse of 1/M - D, D = -sigma'(g). The smooth law answers its part by its own slope, + D/k y/(D + k).
    fn precondition(&self, r: &[f64], now: &State, exact: bool) -> Vec<f64> {
        let (k, d) = (self.k(), each(r.len(), |i| self.hardening(i, now.gap[i])));
        let mut z = self.compliance_times(r, exact);
        let a = self.params.softening;
        if a > 0.0 && !exact {
            let free = |i: usize| choose(r[i] != 0.0, a, 0.0);
            let falls = |i: usize| free(i) * self.softening(i, now.gap[i]);
            z = self.compliance_times(&each(r.len(), |i| r[i] + falls(i) * z[i]), exact);
        }
        each(r.len(), |i| z[i] + d[i] / k * now.y[i] / (d[i] + k))
    }

    /// M r: 1/K where the grid cannot be halved, and with adhesion over a wall until the residual is small, since fronts
    /// that move by another way may end in another solution. Else each grid answers the waves that the next one, of half the
    /// points, cannot hold by one number, in proportion to its pixel: z_k = 2^k c r_k + P z_(k+1), with
    /// r_(k+1) = R r_k, P the interpolation and R the restriction; the finest takes r smoothed by its neighbours. The
    /// coarsest one answers by W (1/2K) W (without a wall W (1/K) W), W being the share of free points there, smoothed,
    /// to the third power: long waves do not reach across contacts.
    fn compliance_times(&self, r: &[f64], exact: bool) -> Vec<f64> {
        let Some(coarsest) = self.coarser.last().filter(|_| !exact) else {
            return self.fourier.filter(r, |q| self.compliance(q));
        };
        let mut residuals = vec![r.to_vec()];
        let mut free = each(r.len(), |i| choose(r[i] != 0.0, 1.0, 0.0));
        for (k, grid) in self.coarser.iter().enumerate() {
            residuals.push(grid.restrict(&residuals[k]));
            free = grid.average(&free);
        }
        let share = (coarsest.fourier).filter(&free, |q| self.smoothing(q));
        let w = each(share.len(), |i| share[i].clamp(0.0, 1.0).powi(3));
        let last = &residuals[self.coarser.len()];
        let weighed = each(w.len(), |i| w[i] * last[i]);
        let long = (coarsest.fourier).filter(&weighed, |q| self.long_compliance(q));
        let mut z = each(w.len(), |i| w[i] * long[i]);
        for (k, grid) in self.coarser.iter().enumerate().rev() {
            let own = |i: usize| match k {
                0 => self.finest_answer(r, i),
                _ => self.params.level_compliance * f64::from(1 << k) * residuals[k][i],
            };
            let coarser = grid.interpolate(&z);
            z = each(coarser.len(), |i| own(i) + coarser[i]);
        }
        z
    }

    /// What the finest grid answers a point with: c times the residual, to which its four neighbours add a share.
    fn finest_answer(&self, r: &[f64], i: usize) -> f64 {
        self.params.own_compliance * r[i] + self.params.neighbour_compliance * self.neighbours(r, i)
    }

    /// Values on F; under a prescribed mean gap less their mean, weighted by S.
    fn project(&self, values: &[f64], now: &State) -> Vec<f64> {
        let (w, total) = (&now.weight, sum(&now.weight));
        let free = self.mean_pressure.is_some() || total == 0.0;
        let mean = choose(free, 0.0, dot(w, values) / total);
        each(w.len(), |i| choose(w[i] > 0.0, values[i] - mean, 0.0))
    }

    /// Step 4: s = max(0, g + a d) - g at a wall, the change of g as v moves by a d with the smooth law,
    /// a d on the pad. Under a prescribed mean gap what the trial leaves of the gap is scaled back to it.
    fn trial(&self, gap: &[f64], direction: &[f64], length: f64) -> Trial {
        let n = gap.len();
        let way = each(n, |i| length * direction[i]);
        let mut s = each(n, |i| match (self.in_domain[i], self.wall[i]) {
            (false, _) => way[i],
            (true, true) => way[i].max(-gap[i]),
            (true, false) => self.gap_at(i, self.variable(i, gap[i]) + way[i]) - gap[i],
        });
        let cut = (0..n).any(|i| self.wall[i] && gap[i] + way[i] < 0.0);
        let w = self.mean_gap_weight(&each(n, |i| gap[i] + s[i]));
        if self.mean_pressure.is_none() && sum(&w) > 0.0 {
            let correction = sum(&s) / sum(&w);
            let corrected = each(n, |i| s[i] - correction * w[i]);
            // A step without a mean closes gaps somewhere, unless its parts cancel to rounding: then it is lost.
            let share = |s: f64, i: usize| choose(gap[i] > 0.0, -s / gap[i], f64::NEG_INFINITY);
            let parts = most(&each(n, |i| share(s[i], i))).abs() + correction.abs();
            let closes = most(&each(n, |i| share(corrected[i], i)));
            let lost = self.has_wall() && closes <= VANISHES * self.params.epsilon * parts;
            s = choose(lost, vec![0.0; n], corrected);
        }
        let touches = |i: usize| self.wall[i] && s[i] < 0.0;
        let touch = each(n, |i| choose(touches(i), gap[i] / -s[i], f64::INFINITY));
        Trial {
            response: self.stiffness_times(&s),
            first_touch: least(&touch).max(1.0),
            cut,
            s,
        }
    }

    /// The slope of the energy at t: <s, y> of the gap g + t s.
    fn slope_at(&self, t: f64, now: &State, trial: &Trial) -> f64 {
        let law = |i| self.traction(i, now.gap[i] + t * trial.s[i]) - self.traction(i, now.gap[i]);
        let y = |i| now.y[i] + t * trial.response[i] + law(i);
        dot(&trial.s, &each(now.gap.len(), y))
    }

    /// Steps 5 and 6: t, from the slope <s, y> and the curvature <s, K*s> of the energy along s.
    fn step_length(&self, now: &State, trial: &Trial, careful: bool) -> StepLength {
        let (s, touch) = (&trial.s, trial.first_touch);
        let (slope, curvature) = (dot(s, &now.y), dot(s, &trial.response));
        if !curvature.is_finite() {
            return StepLength::End(Status::NotFinite);
        } else if !self.has_wall() {
            return self.bracket(now, trial);
        }
        // A rigid motion goes on without end, or down to the first touch.
        let rigid = curvature <= RIGID * slope.abs();
        let lifts = most(s) - least(s) <= SAME_WAY * self.params.epsilon * most(s);
        if self.params.may_detach && least(s) > 0.0 && choose(careful, lifts, rigid) {
            return StepLength::End(Status::PulledOff);
        } else if careful {
            return take(1.0, 1.0);
        } else if rigid {
            let lands = most(s) < 0.0 && touch.is_finite() && self.mean_pressure.is_some();
            return choose(lands, take(touch, touch), StepLength::Lost);
        }
        // The majorant step: exact without attraction, short where that falls with the gap. It ends at the
        // first touch; a trial that the wall has cut is there already.
        let majorant = -slope / curvature;
        let whole = choose(majorant >= WHOLE_STEP, 1.0, majorant);
        let t = choose(trial.cut, whole, majorant.min(touch));
        if self.problem.law.has_tail() && t < touch {
            return self.lengthen(t, majorant, now, trial);
        }
        take(t, majorant)
    }

    /// Step 6 at a wall: the largest tried t up to which the energy falls steeply, or one to which it falls
    /// for sure.
    fn lengthen(&self, mut from: f64, majorant: f64, now: &State, trial: &Trial) -> StepLength {
        let (first, curvature) = (dot(&trial.s, &now.y), dot(&trial.s, &trial.response));
        let (mut before, mut slope_before, mut length) = (0.0, first, majorant);
        for _ in 0..=EXTRAPOLATIONS {
            for reach in [1.0, SECOND_REACH, THIRD_REACH, FOURTH_REACH] {
                let t = (from * reach).min(trial.first_touch);
                let slope = self.slope_at(t, now, trial);
                if before > 0.0 && slope > SEARCH_SHARE * first.abs() {
                    // Too far. The slope rises no faster than without attraction: from the step before it
                    // stays below 0 at least so long.
                    let safe = (before - slope_before / curvature).min(t);
                    return take(safe, safe);
                }
                length = choose(before > 0.0, t, length);
                if slope >= SEARCH_SHARE * first || t >= trial.first_touch {
                    return take(t, length);
                }
                (before, slope_before) = (t, slope);
            }
            from = before * SECOND_REACH;
        }
        take(before, length)
    }

    /// Whether the energy has fallen at t, to rounding.
    fn has_fallen(&self, t: f64, now: &State, trial: &Trial) -> bool {
        let (n, s) = (now.gap.len(), &trial.s);
        let here = each(n, |i| self.energy(i, now.gap[i]));
        let elastic = |i| now.pressure[i] + now.mean_pressure + 0.5 * t * trial.response[i];
        let law = |i| self.energy(i, now.gap[i] + t * s[i]) - here[i];
        let change = sum(&each(n, |i| t * s[i] * elastic(i) + law(i)));
        change <= 4.0 * self.params.epsilon * sum(&each(n, |i| here[i].abs()))
    }

    /// Step 6 of the smooth law: brackets a t at which the slope is small and the energy has fallen.
    fn bracket(&self, now: &State, trial: &Trial) -> StepLength {
        let first = dot(&trial.s, &now.y);
        // The ends: t, the slope there, its weight; and how often the same one has moved.
        let (mut t, mut low, mut high) = (1.0, (0.0, first, 1.0), None);
        let mut last_is_low = None;
        for evaluation in 1..EVALUATIONS {
            let slope = self.slope_at(t, now, trial);
            let fallen = self.has_fallen(t, now, trial);
            let steep = fallen && slope < SEARCH_SHARE * first;
            let enough = evaluation > EXTRAPOLATIONS && steep && high.is_none();
            if enough || (fallen && slope.abs() <= SEARCH_SHARE * first.abs()) {
                return take(t, t);
            }
            let Some(before) = high.or((!steep).then_some((t, slope, 1.0))) else {
                // Extrapolates to where the secant of the slope vanishes, to four times t at most.
                let secant = -slope * (t - low.0) / (slope - low.1);
                low = (t, slope, 1.0);
                t += choose(secant > 0.0, secant.min(3.0 * t), 3.0 * t);
                continue;
            };
            // Where the secant of slope/(|first| + |slope|) vanishes; the end that stays when the other moves twice counts
            // half (the Illinois method).
            let again = choose(last_is_low == Some(steep), 0.5, 1.0);
            last_is_low = Some(steep);
            let end = (t, slope, 1.0);
            let (b, a) = choose(
                steep,
                (end, halved(before, again)),
                (halved(low, again), end),
            );
            (low, high) = (b, Some(a));
            let relative = |end: (f64, f64, f64)| match end.1 / (first.abs() + end.1.abs()) {
                share if share.is_finite() => end.2 * share,
                _ => end.2,
            };
            let share = relative(b) / (relative(b) - relative(a));
            t = b.0 + choose(relative(a) > 0.0, share.clamp(0.1, 0.9), 0.5) * (a.0 - b.0);
        }
        choose(low.0 > 0.0, take(low.0, low.0), StepLength::Lost)
    }

    /// Step 7: g + t s. What closes at a wall is exactly 0, rounding included.
    fn advance(&self, gap: &[f64], trial: &Trial, t: f64, careful: bool) -> Vec<f64> {
        let touches = t == trial.first_touch && !careful;
        let snap = choose(touches, LEAST_SNAP * largest(&trial.s), 0.0);
        each(gap.len(), |i| {
            let moved = gap[i] + t * trial.s[i];
            let closes = moved <= 0.0 || (trial.s[i] < 0.0 && moved < snap);
            choose(self.wall[i] && closes, 0.0, moved)
        })
    }
}

/// An end of a search that counts less.
fn halved((t, slope, weight): (f64, f64, f64), by: f64) -> (f64, f64, f64) {
    (t, slope, by * weight)
}

/// A step of length t; the next trial is longer by a factor within bounds.
fn take(t: f64, lengthen: f64) -> StepLength {
    let lengthen = lengthen.clamp(0.3, 2.0);
    StepLength::Take { t, lengthen }
}
