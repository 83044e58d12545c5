//! A law that repels by itself: no constraint, and another variable in which its steep core is not stiff.
//!
//! Below the gap of largest tension the iteration works in `v = g - (sigma_max - sigma(g))/k`,
//! in which the core is no stiffer than `k`. With D = max(sigma'(g), 0) the change of variable is
//! dg = S2 dv, S2 = k/(k + D). Points of a pad have no law: S2 = 1.

use super::constraint::{GapConstraint, Here, Tried, Violation};
use super::points::{Numbers, PointKernel, side_by_side};
use super::{Params, Rows, SUMS};
use crate::law::{AdhesionMap, Cohesion, CorrectedField, Law, LennardJones, imbalance};
use crate::real::Real;

/// Largest number of Newton steps in the inversion of v(g).
const NEWTON_STEPS: usize = 25;

/// The variable v and its constants in the kernel's number.
#[derive(Clone, Copy)]
pub struct Smooth<T> {
    /// k.
    stiffness: T,
    /// sigma_max.
    peak: T,
    /// Gap of the largest tension.
    peak_gap: T,
    /// Where the inversion stops.
    precision: T,
}

impl<T: Real> Smooth<T> {
    /// D at a value of the unknown.
    #[inline(always)]
    fn hardening(&self, law: &impl Cohesion<T>, gap: T) -> T {
        law.slope(gap).max(T::zero())
    }

    /// S2 at a value of the unknown.
    #[inline(always)]
    pub fn share(&self, law: &impl Cohesion<T>, gap: T) -> T {
        self.stiffness / (self.stiffness + self.hardening(law, gap))
    }

    /// v.
    #[inline(always)]
    fn variable(&self, law: &impl Cohesion<T>, gap: T) -> T {
        if gap < self.peak_gap {
            gap - (law.factored(self.peak) - law.traction(gap)) / self.stiffness
        } else {
            gap
        }
    }

    /// The gap at a value of v, by Newton's method from the tangent at `gap`.
    fn gap_at(&self, law: &impl Cohesion<T>, goal: T, gap: T) -> T {
        if goal >= self.peak_gap {
            return goal;
        }
        // v is concave here: from the left every step stays on the left of the root, so only the
        // start needs a bound, which the repulsive power alone gives.
        let load = self.stiffness * (self.peak_gap - goal) - law.factored(self.peak);
        let bound = law.repelling_gap(load);
        let mut x = gap + (goal - self.variable(law, gap)) * self.share(law, gap);
        x = x.max(bound).min(self.peak_gap);
        for _ in 0..NEWTON_STEPS {
            let error = self.variable(law, x) - goal;
            let next = (x - error * self.share(law, x))
                .max(bound)
                .min(self.peak_gap);
            let moved = (next - x).abs();
            x = next;
            if moved <= self.precision {
                break;
            }
        }
        x
    }
}

impl<T: Real> GapConstraint<T> for Smooth<T> {
    const STORES_STEP: bool = true;

    #[inline(always)]
    fn new(params: &Params) -> Self {
        Smooth {
            stiffness: T::from_double(params.smooth_stiffness),
            peak: T::from_double(params.law.peak_tension()),
            peak_gap: T::from_double(params.law.peak_gap()),
            precision: T::from_double(2.0 * params.epsilon * params.law.range()),
        }
    }

    #[inline(always)]
    fn state(&self, law: &impl Cohesion<T>, gap: T, elastic: T) -> Here<T> {
        let pull = law.traction(gap);
        let hardening = self.hardening(law, gap);
        Here {
            gap,
            open: law.open(gap),
            elastic,
            pull,
            y: imbalance(elastic, pull),
            free: true,
            weight: self.stiffness / (self.stiffness + hardening),
            hardening,
        }
    }

    #[inline(always)]
    fn violation(&self, here: &Here<T>, _: T) -> Violation<T> {
        Violation {
            violation: here.y,
            reaction: T::zero(),
            traction: here.pull,
        }
    }

    /// z / S2: the long-range part, and the local part that the core's own stiffness answers.
    #[inline(always)]
    fn preconditioned(&self, here: &Here<T>, line: T) -> T {
        let hardening = here.hardening;
        line + hardening / self.stiffness * here.y / (hardening + self.stiffness)
    }

    /// The change of g as v moves.
    #[inline(always)]
    fn trial_step(&self, law: &impl Cohesion<T>, here: &Here<T>, moved: T, _: T) -> Tried<T> {
        let step = if law.corrects() {
            // A correction is short: v follows its slope.
            here.weight * moved
        } else {
            self.gap_at(law, self.variable(law, here.gap) + moved, here.gap) - here.gap
        };
        Tried { step, cut: false }
    }

    #[inline(always)]
    fn corrected_step(
        &self,
        law: &impl Cohesion<T>,
        here: &Here<T>,
        step: T,
        correction: T,
        in_domain: bool,
    ) -> T {
        let share = if in_domain {
            self.share(law, here.gap + step)
        } else {
            T::one()
        };
        step - correction * share
    }

    #[inline(always)]
    fn touches(&self, _: T, _: T) -> bool {
        false
    }

    #[inline(always)]
    fn land(&self, here: &Here<T>, step: T, t: T, _: T, _: T) -> T {
        here.gap + t * step
    }

    #[inline(always)]
    fn pressure_weight(&self, here: &Here<T>) -> T {
        here.weight
    }

    fn run<K, const READS: usize, const WRITES: usize, const TERMS: usize>(
        numbers: Numbers<T, Self>,
        params: &Params,
        rows: &mut Rows<T>,
        sums: &mut [f64; SUMS],
    ) where
        K: PointKernel<T, Self, READS, WRITES, TERMS>,
    {
        let law = match params.law {
            Law::LennardJones(law) => law,
            // Other laws have a constraint and never come here; any constants keep this total.
            _ => LennardJones {
                work_of_adhesion: 1.0,
                range: 1.0,
            },
        };
        let law = law.cast::<T>();
        if rows.outer[0].is_empty() {
            side_by_side::<_, _, K, READS, WRITES, TERMS>(numbers, AdhesionMap(law), rows, sums);
        } else {
            side_by_side::<_, _, K, READS, WRITES, TERMS>(numbers, CorrectedField(law), rows, sums);
        }
    }
}
