//! The new direction and its trial step.

use super::constraint::{GapConstraint, HardnessLimit, Here, Move, Tried, Unilateral};
use super::points::{Numbers, Point, PointKernel};
use super::smooth::Smooth;
use super::sums::sum_group;
use super::{Kernel, point_kernel};
use crate::law::Cohesion;
use crate::real::Real;

sum_group! {
    /// What tells whether a trial is taken, and how far.
    TrialSums { slope, first_touch, largest_step, least_step, cut }
}
sum_group! {
    /// Step length 1 of a smooth law, as a search would evaluate it.
    SmoothTrialSums after TrialSums { elastic_slope, change_at_first, energy_change, energy_size }
}
sum_group! {
    /// Of the trial before the prescribed mean gap is restored: all from which the restored one follows.
    LinearTrialSums {
        slope, closing, largest_step, least_step, cut, step_sum, gap_sum, gap_slope,
        step_gap_curvature, gap_curvature,
    }
}
sum_group! {
    /// What restores a mean gap on both sides of zero.
    TwoSidedSums { step_sum, gap_sum, depth_sum }
}
sum_group! {
    /// What restores the mean gap of a smooth law.
    ComplianceSums { step_sum, compliance_sum }
}
impl<T: Real, C: GapConstraint<T>> Numbers<T, C> {
    /// The new direction: zero where the point is not free.
    #[inline(always)]
    fn new_direction(&self, z: T, direction: T, free: bool) -> T {
        if free {
            self.descent_factor * z + self.beta * direction + self.mean_gap_shift
        } else {
            T::zero()
        }
    }

    /// The move along a direction by the trial length.
    #[inline(always)]
    pub(super) fn way(&self, direction: T, correction: T, found: T) -> Move<T> {
        Move {
            moved: self.trial_length * direction,
            correction,
            found,
        }
    }

    /// The trial step of a point by a move; a pad has no constraint.
    #[inline(always)]
    pub(super) fn step_at(
        &self,
        law: &impl Cohesion<T>,
        here: &Here<T>,
        way: Move<T>,
        in_domain: bool,
    ) -> Tried<T> {
        if in_domain {
            self.constraint.trial_step(law, here, way)
        } else {
            Tried {
                step: way.moved,
                cut: false,
            }
        }
    }

    /// The iteration's variable after the trial step of a point that is always free.
    #[inline(always)]
    fn goal(&self, law: &impl Cohesion<T>, gap: T, [z, direction]: [T; 2]) -> T {
        let moved = self.trial_length * self.new_direction(z, direction, true);
        self.constraint.goal(law, gap, moved)
    }
}

/// The terms of a trial step.
#[inline(always)]
fn trial_terms<T: Real>(
    constraint: &impl GapConstraint<T>,
    tried: Tried<T>,
    here: &Here<T>,
    in_domain: bool,
) -> TrialSums<T> {
    let s = tried.step;
    let closes = constraint.touches(here.open, tried.step);
    let ratio = here.open / -s;
    TrialSums {
        slope: s * here.y,
        first_touch: if closes & in_domain {
            ratio
        } else {
            T::infinity()
        },
        largest_step: s,
        least_step: s,
        cut: if tried.cut { T::one() } else { T::zero() },
    }
}

/// What a smooth law's trial asks besides.
#[inline(always)]
fn smooth_trial_terms<T: Real>(
    law: &impl Cohesion<T>,
    step: T,
    here: &Here<T>,
    in_domain: bool,
) -> SmoothTrialSums<T> {
    if in_domain {
        let [energy, size] = law.energy_change(here.gap, step);
        SmoothTrialSums {
            elastic_slope: step * here.elastic,
            change_at_first: law.change(here.gap, step) * step,
            energy_change: energy,
            energy_size: size,
        }
    } else {
        SmoothTrialSums {
            elastic_slope: step * here.elastic,
            change_at_first: T::zero(),
            energy_change: T::zero(),
            energy_size: T::zero(),
        }
    }
}

/// The terms of a trial s0 before the mean gap is restored; `bent` is K g.
#[inline(always)]
fn linear_trial_terms<T: Real>(tried: Tried<T>, here: &Here<T>, bent: T) -> LinearTrialSums<T> {
    let (s, y, g) = (tried.step, here.y, here.open);
    LinearTrialSums {
        slope: s * y,
        closing: if g > T::zero() {
            -s / g
        } else {
            T::neg_infinity()
        },
        largest_step: s,
        least_step: s,
        cut: if tried.cut { T::one() } else { T::zero() },
        step_sum: s,
        gap_sum: g,
        gap_slope: g * y,
        step_gap_curvature: s * bent,
        gap_curvature: g * bent,
    }
}

/// The new direction and its trial step; `LINEAR` where the mean gap is prescribed, to which the trial is
/// brought back by linearity.
struct Trial<const LINEAR: bool>;

impl<T, C, const LINEAR: bool, const READS: usize, const WRITES: usize, const TERMS: usize>
    PointKernel<T, C, READS, WRITES, TERMS> for Trial<LINEAR>
where
    T: Real,
    C: GapConstraint<T>,
{
    const SEEKS: bool = C::STORES_STEP;

    #[inline(always)]
    fn goal(
        numbers: &Numbers<T, C>,
        law: &impl Cohesion<T>,
        point: &Point<T, READS, WRITES, TERMS>,
    ) -> T {
        numbers.goal(law, point.reads[0], [point.line, point.writes[0]])
    }

    #[inline(always)]
    fn at(
        numbers: &Numbers<T, C>,
        law: &impl Cohesion<T>,
        point: &mut Point<T, READS, WRITES, TERMS>,
    ) {
        let (gap, pressure, in_domain) = (point.reads[0], point.reads[1], point.in_domain);
        let here = numbers.here_at(law, [gap, pressure], in_domain);
        let d = numbers.new_direction(point.line, point.writes[0], here.free);
        let way = numbers.way(d, T::zero(), point.found);
        let tried = numbers.step_at(law, &here, way, in_domain);
        if LINEAR {
            linear_trial_terms(tried, &here, pressure - point.reads[2]).put(&mut point.terms);
        } else {
            trial_terms(&numbers.constraint, tried, &here, in_domain).put(&mut point.terms);
        }
        point.writes[0] = d;
        if C::STORES_STEP {
            point.writes[1] = tried.step;
            smooth_trial_terms(law, tried.step, &here, in_domain).put(&mut point.terms);
        }
        point.line = tried.step;
    }
}

/// Steps 3 and 4, the direction and `plain::trial`: turns the direction by the retained rows of z and fills
/// the rows of a transform with the trial step s.
pub static TRIAL: [Kernel; 3] = [
    point_kernel!(
        trial, FromRetained, gate Running, Trial over Unilateral [LINEAR = false],
        reads [gap, pressure], writes [direction], unbound [heights_pressure, step], sums [TrialSums]
    ),
    point_kernel!(
        trial, FromRetained, gate Running, Trial over HardnessLimit [LINEAR = false],
        reads [gap, pressure], writes [direction], unbound [heights_pressure, step], sums [TrialSums]
    ),
    point_kernel!(
        trial, FromRetained, gate Running, Trial over Smooth [LINEAR = false],
        reads [gap, pressure], writes [direction, step], fresh 1, unbound [heights_pressure],
        sums [TrialSums, SmoothTrialSums]
    ),
];

/// The same under a prescribed mean gap and a unilateral constraint: the trial step s0 as it is before the
/// mean gap is restored, with all sums from which the restored one follows.
pub static LINEAR_TRIAL: Kernel = point_kernel!(
    trial, FromRetained, gate Running, Trial over Unilateral [LINEAR = true],
    reads [gap, pressure, heights_pressure], writes [direction], unbound [step], sums [LinearTrialSums]
);

/// The new direction, with what its trial step takes off the mean gap.
struct Direction;

impl<T, C, const READS: usize, const WRITES: usize, const TERMS: usize>
    PointKernel<T, C, READS, WRITES, TERMS> for Direction
where
    T: Real,
    C: GapConstraint<T>,
{
    const SEEKS: bool = C::STORES_STEP;

    #[inline(always)]
    fn goal(
        numbers: &Numbers<T, C>,
        law: &impl Cohesion<T>,
        point: &Point<T, READS, WRITES, TERMS>,
    ) -> T {
        numbers.goal(law, point.reads[0], [point.line, point.writes[0]])
    }

    #[inline(always)]
    fn at(
        numbers: &Numbers<T, C>,
        law: &impl Cohesion<T>,
        point: &mut Point<T, READS, WRITES, TERMS>,
    ) {
        let (gap, in_domain) = (point.reads[0], point.in_domain);
        let pressure = if C::STORES_STEP {
            T::zero()
        } else {
            point.reads[1]
        };
        let here = numbers.here_at(law, [gap, pressure], in_domain);
        let d = numbers.new_direction(point.line, point.writes[0], here.free);
        let way = numbers.way(d, T::zero(), point.found);
        let step = numbers.step_at(law, &here, way, in_domain).step;
        point.writes[0] = d;
        if C::STORES_STEP {
            point.writes[1] = step;
            let after = numbers.here_at(law, [gap + step, pressure], in_domain);
            ComplianceSums {
                step_sum: step,
                compliance_sum: after.weight,
            }
            .put(&mut point.terms);
        } else {
            let depth = (-(gap + step)).most(T::zero());
            TwoSidedSums {
                step_sum: step,
                gap_sum: gap,
                depth_sum: depth,
            }
            .put(&mut point.terms);
        }
    }
}

/// Steps 3 and 4 under a prescribed mean gap where the trial does not follow by linearity: turns the direction
/// by the retained rows of z and sums what restores the mean gap.
pub static TWO_SIDED_DIRECTION: Kernel = point_kernel!(
    direction, ReadRetained, gate Running, Direction over HardnessLimit [],
    reads [gap, pressure], writes [direction], unbound [step], sums [TwoSidedSums]
);
/// The same of a smooth law.
pub static SMOOTH_DIRECTION: Kernel = point_kernel!(
    direction, ReadRetained, gate Running, Direction over Smooth [],
    reads [gap], writes [direction, step], fresh 1, unbound [pressure], sums [ComplianceSums]
);

/// The trial step brought back to the prescribed mean gap.
struct LoadTrial;

impl<T, C, const READS: usize, const WRITES: usize, const TERMS: usize>
    PointKernel<T, C, READS, WRITES, TERMS> for LoadTrial
where
    T: Real,
    C: GapConstraint<T>,
{
    #[inline(always)]
    fn at(
        numbers: &Numbers<T, C>,
        law: &impl Cohesion<T>,
        point: &mut Point<T, READS, WRITES, TERMS>,
    ) {
        let (gap, pressure, in_domain) = (point.reads[0], point.reads[1], point.in_domain);
        let correction = numbers.mean_gap_correction;
        let here = numbers.here_at(law, [gap, pressure], in_domain);
        let mut tried = if C::STORES_STEP {
            let (constraint, stored) = (&numbers.constraint, point.writes[0]);
            let step = constraint.corrected_step(law, &here, stored, correction, in_domain);
            point.writes[0] = step;
            Tried { step, cut: false }
        } else {
            let way = numbers.way(point.reads[2], correction, gap);
            numbers.step_at(law, &here, way, in_domain)
        };
        let mut terms = trial_terms(&numbers.constraint, tried, &here, in_domain);
        // A trial that nothing brings back is lost: one that moves and does not descend.
        let lost = !(C::STORES_STEP || correction > -T::one() && correction < T::one());
        if lost {
            let (slope, cut, infinity) = (T::zero(), T::zero(), T::infinity());
            let (first_touch, largest_step, least_step) = (infinity, T::one(), infinity);
            terms = TrialSums {
                slope,
                first_touch,
                largest_step,
                least_step,
                cut,
            };
            tried.step = T::zero();
        }
        terms.put(&mut point.terms);
        if C::STORES_STEP {
            smooth_trial_terms(law, tried.step, &here, in_domain).put(&mut point.terms);
        }
        point.line = tried.step;
    }
}

/// Step 4 under a prescribed mean gap, the end of `plain::trial`: fills the rows of a transform with the
/// trial step brought back to the mean gap.
pub static TWO_SIDED_LOAD_TRIAL: Kernel = point_kernel!(
    load_trial, Load, gate Running, LoadTrial over HardnessLimit [],
    reads [gap, pressure, direction], writes [], unbound [step], sums [TrialSums]
);
/// The same of a smooth law, in proportion to the local compliance.
pub static SMOOTH_LOAD_TRIAL: Kernel = point_kernel!(
    load_trial, Load, gate Running, LoadTrial over Smooth [],
    reads [gap, pressure], writes [step], unbound [direction], sums [TrialSums, SmoothTrialSums]
);
