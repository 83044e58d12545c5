//! Steps 5 and 6 of the method: how far a trial step is taken.

use super::Trial;
use super::contact::Contact;
use crate::kernel::Status;

/// Majorant step from which a cut trial is taken whole.
const WHOLE_STEP: f64 = 0.6;
/// Factors between which one step may change the next trial length.
const LENGTHEN: [f64; 2] = [0.3, 2.0];
/// Curvature over slope below which a step is a rigid motion.
const RIGID: f64 = 1e-30;
/// Share of the first slope at which a search ends.
const SEARCH_SHARE: f64 = 0.1;
/// Steps that a pass of a search at a wall tries, over the first one.
const REACHES: [f64; 4] = [1.0, 1.75, 3.0, 5.0];
/// Extrapolations that one search may make.
const EXTRAPOLATIONS: usize = 6;
/// Evaluations that one bracket may take.
const EVALUATIONS: usize = 40;

/// The energy along a trial step: its slope there is `slope + t curvature` and what the law adds.
pub struct Line<'a> {
    /// `<s, y>`, negative.
    pub slope: f64,
    /// The part of it that the elastic pressure makes.
    pub elastic_slope: f64,
    /// `<s, K s>`.
    pub curvature: f64,
    pub gap: &'a [f64],
    pub trial: &'a Trial,
}

/// How far a trial step is taken.
pub enum Length {
    /// By t; the next trial is this much longer.
    Step { t: f64, lengthen: f64 },
    /// Nowhere; `tried` if it counts as an iteration.
    None { tried: bool },
    /// The solve is over.
    End(Status),
}

impl Length {
    pub fn of(t: f64, lengthen: f64) -> Self {
        Length::Step { t, lengthen }
    }
}

impl Contact<'_> {
    /// What the law adds to slope and energy after t along a trial step, and the size of the energy.
    fn along(&self, line: &Line, t: f64) -> [f64; 3] {
        let law = &self.problem.law;
        let mut sums = [0.0; 3];
        for (i, (&gap, &s)) in line.gap.iter().zip(&line.trial.s).enumerate() {
            if self.in_domain[i] {
                let [here, there] = [gap, gap + t * s].map(|gap| self.factor[i] * law.energy(gap));
                sums[0] += (self.traction(i, gap + t * s) - self.traction(i, gap)) * s;
                sums[1] += there - here;
                sums[2] += here.abs();
            }
        }
        sums
    }

    /// Step 5: the majorant step -<s, y>/<s, K s>, exact without attraction and too short where that
    /// falls with the gap; no further than to the first touch.
    pub fn length(&self, line: &Line) -> Length {
        let Line {
            slope,
            curvature,
            trial,
            ..
        } = line;
        let first = trial.first_touch;
        if !curvature.is_finite() {
            return Length::End(Status::NotFinite);
        }
        if !self.problem.law.has_wall() {
            return self.bracketed(line);
        }
        if *curvature <= RIGID * slope.abs() {
            // A rigid motion: apart without end, or down to the first touch; a prescribed mean gap
            // leaves none, and what looks like one is rounding.
            return if self.may_detach && trial.s.iter().all(|s| *s > 0.0) {
                Length::End(Status::PulledOff)
            } else if first.is_finite()
                && self.mean_pressure.is_some()
                && trial.s.iter().all(|s| *s < 0.0)
            {
                Length::of(first, first.clamp(LENGTHEN[0], LENGTHEN[1]))
            } else {
                Length::None { tried: true }
            };
        }
        let majorant = -slope / curvature;
        // A cut trial has touched already: it is taken whole, or as far as the majorant reaches.
        let t = if !trial.cut {
            majorant.min(first)
        } else if majorant >= WHOLE_STEP {
            1.0
        } else {
            majorant
        };
        let (t, length) = if self.problem.law.has_tail() && t < first {
            self.lengthened(line, t, majorant)
        } else {
            (t, majorant)
        };
        Length::of(t, length.clamp(LENGTHEN[0], LENGTHEN[1]))
    }

    /// Step 6: where the law has a tail, the largest tried t up to which the energy falls steeply.
    fn lengthened(&self, line: &Line, mut start: f64, majorant: f64) -> (f64, f64) {
        let (first, farthest) = (line.slope, line.trial.first_touch);
        let (mut before, mut slope_before) = (0.0, first);
        let mut length = majorant;
        for _ in 0..=EXTRAPOLATIONS {
            for reach in REACHES {
                let t = (start * reach).min(farthest);
                let slope = first + t * line.curvature + self.along(line, t)[0];
                let too_far = slope.is_nan() || slope > SEARCH_SHARE * first.abs();
                if before > 0.0 && too_far {
                    // The energy curves no more than without attraction: from the step before it falls
                    // at least as far as its slope there takes to rise to zero.
                    let safe = (before - slope_before / line.curvature).min(t);
                    return (safe, safe);
                }
                if before > 0.0 {
                    length = t;
                }
                (before, slope_before) = (t, slope);
                if slope >= SEARCH_SHARE * first || t >= farthest {
                    return (t, length);
                }
            }
            start = before * REACHES[1];
        }
        (before, length)
    }

    /// Step 6 of a smooth law: t where the slope is small and the energy has fallen, from t = 1 on.
    fn bracketed(&self, line: &Line) -> Length {
        let first = line.slope;
        let (mut t, mut low, mut high) = (1.0, (0.0, first), None);
        let mut slope_at_one = None;
        for evaluation in 1..=EVALUATIONS {
            let [change, energy, size] = self.along(line, t);
            let slope = first + t * line.curvature + change;
            let energy = energy + t * line.elastic_slope + 0.5 * t * t * line.curvature;
            let fallen = energy <= 4.0 * f64::EPSILON * size;
            let still_falling = slope < SEARCH_SHARE * first && fallen;
            slope_at_one.get_or_insert(slope);
            let found = fallen && slope.abs() <= SEARCH_SHARE * first.abs();
            let far_enough = still_falling && high.is_none() && evaluation > EXTRAPOLATIONS;
            if evaluation == EVALUATIONS && low.0 == 0.0 {
                return Length::None { tried: false };
            }
            if evaluation == EVALUATIONS || found || far_enough {
                if evaluation == EVALUATIONS {
                    t = low.0;
                }
                break;
            }
            if still_falling && high.is_none() {
                let rise = (slope - low.1) / (t - low.0);
                let secant = if rise > 0.0 {
                    -slope / rise
                } else {
                    f64::INFINITY
                };
                low = (t, slope);
                t += (3.0 * t).min(secant);
                continue;
            }
            if still_falling {
                low = (t, slope)
            } else {
                high = Some((t, slope))
            }
            let (end, slope_at_end) = high.unwrap_or(low);
            let share = low.1 / (low.1 - slope_at_end);
            let share = if share.is_finite() {
                share.clamp(0.1, 0.9)
            } else {
                0.2
            };
            t = low.0 + share * (end - low.0);
        }
        let falls_at_one = slope_at_one.is_some_and(|slope| slope < SEARCH_SHARE * first);
        let lengthen = if t < 1.0 {
            t.max(LENGTHEN[0])
        } else if falls_at_one {
            t.clamp(1.5, LENGTHEN[1])
        } else {
            1.0
        };
        Length::of(t, lengthen)
    }
}
