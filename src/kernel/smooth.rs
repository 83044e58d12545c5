//! A law that repels by itself: no constraint, and another variable in which its steep core is not stiff.
//!
//! Below the gap of largest tension the iteration works in `v = g - (sigma_max - sigma(g))/k`,
//! in which the core is no stiffer than `k`. With D = max(sigma'(g), 0) the change of variable is
//! dg = S2 dv, S2 = k/(k + D). Points of a pad have no law: S2 = 1.

use super::constraint::{GapConstraint, Here, Move, Tried, Violation};
use super::points::{Numbers, PointKernel, side_by_side};
use super::seek::{Sought, Variable};
use super::{Params, Rows, SUMS};
use crate::law::{AdhesionMap, Cohesion, CorrectedField, Law, LennardJones, imbalance};
use crate::real::Real;

/// Ranges of the law within which the search needs some steps more and no bound.
const NEARBY: f64 = 0.1;
/// A step of Halley's method leaves an error of a constant times its third power. In shares of the distance the constant is 7
/// where the core is steep, so that the step after one of this many cube roots of the rounding error would be below rounding.
const LAST_STEP: f64 = 0.4;

/// The variable v and its constants in the kernel's number.
#[derive(Clone, Copy)]
pub struct Smooth<T> {
    /// k.
    stiffness: T,
    /// 1/k.
    compliance: T,
    /// sigma_max.
    peak: T,
    /// Gap of the largest tension.
    peak_gap: T,
    /// How far from the gap a start needs no bound.
    nearby: T,
    /// Step, as a share of the distance, after which no other is needed.
    last_step: T,
    /// Range of the law.
    range: T,
}

impl<T: Real> Smooth<T> {
    /// D at a value of the unknown.
    #[inline(always)]
    fn hardening(&self, law: &impl Cohesion<T>, gap: T) -> T {
        law.slope(gap).most(T::zero())
    }

    /// S2 at a value of the unknown.
    #[inline(always)]
    pub fn share(&self, law: &impl Cohesion<T>, gap: T) -> T {
        self.stiffness / (self.stiffness + self.hardening(law, gap))
    }

    /// v.
    #[inline(always)]
    fn variable(&self, law: &impl Cohesion<T>, gap: T) -> T {
        let core = (law.factored(self.peak) - law.traction(gap)) * self.compliance;
        if gap < self.peak_gap { gap - core } else { gap }
    }

    /// The gap at a value of v by the tangent at another gap.
    #[inline(always)]
    fn by_tangent(&self, law: &impl Cohesion<T>, goal: T, gap: T) -> T {
        let error = self.variable(law, gap) - goal;
        (gap - error * self.share(law, gap)).least(self.peak_gap)
    }

    /// One step of Halley's method from a gap to that at a value of v, within the core: with v' and v'' there.
    #[inline(always)]
    fn by_halley(&self, law: &impl Cohesion<T>, goal: T, gap: T, bound: T) -> T {
        let error = self.variable(law, gap) - goal;
        let slope = T::one() + self.compliance * self.hardening(law, gap);
        let half_bend = T::from_double(0.5) * self.compliance * law.bend(gap);
        let next = gap - error * slope / (slope * slope - error * half_bend);
        next.most(bound).least(self.peak_gap)
    }
}

impl<T: Real> Variable<T> for Smooth<T> {
    #[inline(always)]
    fn goal(&self, law: &impl Cohesion<T>, gap: T, moved: T) -> T {
        if law.corrects() {
            // Nothing is sought.
            T::infinity()
        } else {
            self.variable(law, gap) + moved
        }
    }

    #[inline(always)]
    fn is_bent(&self, goal: T) -> bool {
        goal < self.peak_gap
    }

    /// From the tangent at the gap. v is concave in the core, so that this start is on the left of what is sought and bounds the
    /// other steps. Only one that is far needs a bound itself, which the repulsive power alone gives.
    #[inline(always)]
    fn sought(&self, law: &impl Cohesion<T>, goal: T, gap: T) -> Sought<T> {
        let bent = self.is_bent(goal);
        let start = self.by_tangent(law, goal, gap);
        let start = if bent { start } else { goal };
        Sought {
            goal,
            gap: start,
            bound: start,
            left: if bent { T::infinity() } else { T::zero() },
        }
    }

    #[inline(always)]
    fn is_far(&self, sought: &Sought<T>, gap: T) -> bool {
        sought.gap < gap.least(self.peak_gap) - self.nearby
    }

    #[inline(always)]
    fn bounded(&self, law: &impl Cohesion<T>, sought: Sought<T>, gap: T) -> Sought<T> {
        let load = self.stiffness * (self.peak_gap - sought.goal) - law.factored(self.peak);
        let bound = law.repelling_gap(load);
        let start = sought.gap.most(bound).least(self.peak_gap);
        let far = self.is_far(&sought, gap);
        Sought {
            gap: if far { start } else { sought.gap },
            bound: if far { bound } else { sought.bound },
            ..sought
        }
    }

    #[inline(always)]
    fn is_open(&self, left: T) -> bool {
        left > T::zero()
    }

    #[inline(always)]
    fn nearer(&self, law: &impl Cohesion<T>, sought: Sought<T>) -> Sought<T> {
        let Sought {
            goal,
            gap,
            bound,
            left,
        } = sought;
        let next = self.by_halley(law, goal, gap, bound);
        let beyond = (next - gap).abs() - self.last_step * (next + self.range);
        let open = self.is_open(left);
        Sought {
            gap: if open { next } else { gap },
            left: if open { beyond } else { left },
            ..sought
        }
    }
}

impl<T: Real> GapConstraint<T> for Smooth<T> {
    const STORES_STEP: bool = true;

    #[inline(always)]
    fn new(params: &Params) -> Self {
        Smooth {
            stiffness: T::from_double(params.smooth_stiffness),
            compliance: T::from_double(1.0 / params.smooth_stiffness),
            peak: T::from_double(params.law.peak_tension()),
            peak_gap: T::from_double(params.law.peak_gap()),
            nearby: T::from_double(NEARBY * params.law.range()),
            last_step: T::from_double(LAST_STEP * params.epsilon.cbrt()),
            range: T::from_double(params.law.range()),
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
        line + hardening * self.compliance * here.y / (hardening + self.stiffness)
    }

    /// The change of g as v moves.
    #[inline(always)]
    fn trial_step(&self, law: &impl Cohesion<T>, here: &Here<T>, way: Move<T>) -> Tried<T> {
        let step = if law.corrects() {
            // A correction is short: v follows its slope.
            here.weight * way.moved
        } else {
            way.found - here.gap
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
        if rows.outer_gap.is_empty() {
            side_by_side::<_, _, K, READS, WRITES, TERMS>(numbers, AdhesionMap(law), rows, sums);
        } else {
            side_by_side::<_, _, K, READS, WRITES, TERMS>(numbers, CorrectedField(law), rows, sums);
        }
    }
}
