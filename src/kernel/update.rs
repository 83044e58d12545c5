//! Kernels that take the step along a direction, and with it the mean pressure or the residual that follows.

use std::marker::PhantomData;

use super::constraint::{GapConstraint, HardnessLimit, Unilateral, here_at, projected_residual};
use super::measure::{ResidualSums, residual_terms};
use super::points::{Made, Point, PointKernel};
use super::smooth::Smooth;
use super::sums::sum_group;
use super::trial::step_at;
use super::{Kernel, Params, Scalars, point_kernel, point_kernels};
use crate::law::Cohesion;
use crate::real::Real;

sum_group! {
    /// What the step says of its direction.
    AlongSums after ResidualSums { direction_change, direction_residual }
}
sum_group! {
    /// What gives the mean pressure that a prescribed mean gap takes.
    PressureSums { weighted_pressure, pressure_weight, least_pressure }
}

/// What a step is made of, from the scalars.
#[derive(Clone, Copy)]
struct Step<T> {
    /// Whether there is one: a lost trial leaves all as it is.
    taken: bool,
    mean_pressure: T,
    trial_length: T,
    correction: T,
    length: T,
    snap: T,
}

/// A point after a step, and its projected residual before it.
struct Moved<T> {
    gap: T,
    pressure: T,
    previous: T,
}

impl<T: Real> Step<T> {
    #[inline(always)]
    fn new(scalars: &Scalars) -> Self {
        Step {
            taken: scalars.accepted,
            mean_pressure: T::of(scalars.mean_pressure),
            trial_length: T::of(scalars.trial_length),
            correction: T::of(scalars.mean_gap_correction),
            length: T::of(scalars.step),
            snap: T::of(scalars.snap),
        }
    }

    /// A point after the step along a direction, or by the kept trial step, which the elastic pressure
    /// `answer`s.
    #[inline(always)]
    fn step_from<C: GapConstraint<T>>(
        &self,
        constraint: &C,
        law: &impl Cohesion<T>,
        [gap, pressure]: [T; 2],
        [moved, answer]: [T; 2],
        in_domain: bool,
    ) -> Moved<T> {
        let here = here_at(
            constraint,
            law,
            gap,
            pressure + self.mean_pressure,
            in_domain,
        );
        let step = if C::STORES_STEP {
            moved
        } else {
            let way = [self.trial_length * moved, self.correction];
            step_at(constraint, law, &here, way, in_domain).step
        };
        let t = self.length;
        let after = if in_domain {
            constraint.land(&here, step, t, self.snap, law.closed_gap())
        } else {
            gap + t * step
        };
        let pushed = pressure + t * answer;
        Moved {
            gap: if self.taken { after } else { gap },
            pressure: if self.taken { pushed } else { pressure },
            previous: projected_residual(&here),
        }
    }
}

/// The step, and the projected residual after it.
#[derive(Clone, Copy)]
struct UpdateState<T, C> {
    constraint: C,
    step: Step<T>,
    stiffness_max: T,
}

impl<T, C, const READS: usize, const WRITES: usize> PointKernel<T, READS, WRITES, 6>
    for UpdateState<T, C>
where
    T: Real,
    C: GapConstraint<T>,
{
    #[inline(always)]
    fn new(params: &Params, scalars: &Scalars) -> Self {
        UpdateState {
            constraint: C::new(params),
            step: Step::new(scalars),
            stiffness_max: T::of(params.stiffness_max),
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, READS, WRITES>) -> Made<T, WRITES, 6> {
        let (direction, in_domain) = (point.reads[0], point.in_domain);
        // The kept step, where there is one, else the direction again.
        let way = [point.reads[READS - 1], point.line];
        let state = [point.writes[0], point.writes[1]];
        let Moved {
            gap,
            pressure,
            previous,
        } = self
            .step
            .step_from(&self.constraint, law, state, way, in_domain);
        let elastic = pressure + self.step.mean_pressure;
        let here = here_at(&self.constraint, law, gap, elastic, in_domain);
        let residual = projected_residual(&here);
        let mut terms = [0.0; 6];
        residual_terms(&self.constraint, law, &here, self.stiffness_max, in_domain).put(&mut terms);
        let [d, r] = [direction, residual].map(T::double);
        AlongSums {
            direction_change: d * (r - previous.double()),
            direction_residual: d * r,
        }
        .put(&mut terms);
        let mut writes = point.writes;
        (writes[0], writes[1], writes[2]) = (gap, pressure, previous);
        if WRITES > 3 {
            writes[3] = residual;
        }
        Made {
            writes,
            line: residual,
            terms,
        }
    }
}

/// Step 7, `plain::advance`, and step 1 of the next iteration: takes K s and steps, g += t s, p += t K s; then
/// fills the rows of a transform with the new projected residual, with the sums of the step's direction.
pub static UPDATE_STATE: [Kernel; 3] = [
    point_kernel!(
        update_state, InverseThenForward, gate Running, UpdateState over Unilateral [],
        reads [direction], writes [gap, pressure, previous_residual], fresh 1,
        unbound [step, projected_residual], sums [ResidualSums, AlongSums]
    ),
    point_kernel!(
        update_state, InverseThenForward, gate Running, UpdateState over HardnessLimit [],
        reads [direction], writes [gap, pressure, previous_residual], fresh 1,
        unbound [step, projected_residual], sums [ResidualSums, AlongSums]
    ),
    point_kernel!(
        update_state, InverseThenForward, gate Running, UpdateState over Smooth [],
        reads [direction, step], writes [gap, pressure, previous_residual], fresh 1,
        unbound [projected_residual], sums [ResidualSums, AlongSums]
    ),
];

/// The same, which stores the new projected residual for the levels of the preconditioner.
pub static UPDATE_AND_STORE: [Kernel; 3] = [
    point_kernel!(
        update_state, Store, gate Running, UpdateState over Unilateral [],
        reads [direction], writes [gap, pressure, previous_residual, projected_residual], fresh 2,
        unbound [step], sums [ResidualSums, AlongSums]
    ),
    point_kernel!(
        update_state, Store, gate Running, UpdateState over HardnessLimit [],
        reads [direction], writes [gap, pressure, previous_residual, projected_residual], fresh 2,
        unbound [step], sums [ResidualSums, AlongSums]
    ),
    point_kernel!(
        update_state, Store, gate Running, UpdateState over Smooth [],
        reads [direction, step], writes [gap, pressure, previous_residual, projected_residual], fresh 2,
        unbound [], sums [ResidualSums, AlongSums]
    ),
];

/// The terms of the mean pressure that a prescribed mean gap takes.
#[inline(always)]
fn balance_terms<T: Real>(
    constraint: &impl GapConstraint<T>,
    law: &impl Cohesion<T>,
    [gap, pressure]: [T; 2],
    in_domain: bool,
) -> PressureSums {
    // The mean pressure is what these terms are to give.
    let here = here_at(constraint, law, gap, pressure, in_domain);
    let traction = if in_domain {
        constraint.net_traction(&here)
    } else {
        here.pull
    };
    let y = (pressure + traction).double();
    let weight = constraint.pressure_weight(&here).double();
    PressureSums {
        weighted_pressure: weight * y,
        pressure_weight: weight,
        least_pressure: y,
    }
}

/// The step, where the mean gap is prescribed.
#[derive(Clone, Copy)]
struct Advance<T, C, const LINEAR: bool> {
    constraint: C,
    step: Step<T>,
}

impl<T, C, const LINEAR: bool, const READS: usize> PointKernel<T, READS, 3, 3>
    for Advance<T, C, LINEAR>
where
    T: Real,
    C: GapConstraint<T>,
{
    #[inline(always)]
    fn new(params: &Params, scalars: &Scalars) -> Self {
        Advance {
            constraint: C::new(params),
            step: Step::new(scalars),
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, READS, 3>) -> Made<T, 3, 3> {
        let [gap, pressure, _] = point.writes;
        let mut answer = point.line;
        if LINEAR {
            // K s from K s0 and K g, see `mean_gap`.
            let bent = pressure - point.reads[1];
            answer = answer + self.step.correction * (answer + bent);
        }
        let way = [point.reads[0], answer];
        let moved =
            self.step
                .step_from(&self.constraint, law, [gap, pressure], way, point.in_domain);
        let state = [moved.gap, moved.pressure];
        let mut terms = [0.0; 3];
        balance_terms(&self.constraint, law, state, point.in_domain).put(&mut terms);
        Made {
            writes: [moved.gap, moved.pressure, moved.previous],
            line: point.line,
            terms,
        }
    }
}

/// Step 7 under a prescribed mean gap, `plain::advance`: takes K s (of a unilateral constraint K s0) and steps;
/// sums as `balance`.
pub static ADVANCE: [Kernel; 3] = [
    point_kernel!(
        advance, Store, gate Running, Advance over Unilateral [LINEAR = true],
        reads [direction, heights_pressure], writes [gap, pressure, previous_residual], fresh 1,
        unbound [step], sums [PressureSums]
    ),
    point_kernel!(
        advance, Store, gate Running, Advance over HardnessLimit [LINEAR = false],
        reads [direction], writes [gap, pressure, previous_residual], fresh 1,
        unbound [heights_pressure, step], sums [PressureSums]
    ),
    point_kernel!(
        advance, Store, gate Running, Advance over Smooth [LINEAR = false],
        reads [step], writes [gap, pressure, previous_residual], fresh 1,
        unbound [direction, heights_pressure], sums [PressureSums]
    ),
];

/// What gives the mean pressure under a prescribed mean gap.
#[derive(Clone, Copy)]
struct Balance<T, C> {
    constraint: C,
    number: PhantomData<T>,
}

impl<T: Real, C: GapConstraint<T>> PointKernel<T, 2, 0, 3> for Balance<T, C> {
    #[inline(always)]
    fn new(params: &Params, _: &Scalars) -> Self {
        Balance {
            constraint: C::new(params),
            number: PhantomData,
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 2, 0>) -> Made<T, 0, 3> {
        let mut terms = [0.0; 3];
        balance_terms(&self.constraint, law, point.reads, point.in_domain).put(&mut terms);
        Made {
            writes: [],
            line: point.line,
            terms,
        }
    }
}

point_kernels!(
    /// `plain::state`: the sums that give the mean pressure under a prescribed mean gap.
    BALANCE, balance, Sweep, gate Running, Balance [],
    reads [gap, pressure], writes [], sums [PressureSums]
);
