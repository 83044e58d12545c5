//! Kernels that take the step along a direction, and with it the mean pressure or the residual that follows.

use super::constraint::{GapConstraint, HardnessLimit, Unilateral, here_at, projected_residual};
use super::measure::{ResidualSums, residual_terms};
use super::points::{Numbers, Point, PointKernel};
use super::smooth::Smooth;
use super::sums::sum_group;
use super::{Kernel, point_kernel, point_kernels};
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

/// A point after a step, and its projected residual before it.
struct Moved<T> {
    gap: T,
    pressure: T,
    previous: T,
}

impl<T: Real, C: GapConstraint<T>> Numbers<T, C> {
    /// A point after the step along a direction, or by the kept trial step, which the elastic pressure
    /// `answer`s.
    #[inline(always)]
    fn step_from(
        &self,
        law: &impl Cohesion<T>,
        [gap, pressure]: [T; 2],
        [moved, answer]: [T; 2],
        in_domain: bool,
    ) -> Moved<T> {
        let here = self.here_at(law, [gap, pressure], in_domain);
        let step = if C::STORES_STEP {
            moved
        } else {
            let way = self.way(moved, self.mean_gap_correction, gap);
            self.step_at(law, &here, way, in_domain).step
        };
        let t = self.step;
        let after = if in_domain {
            let closed = law.closed_gap();
            self.constraint.land(&here, step, t, self.snap, closed)
        } else {
            gap + t * step
        };
        let pushed = pressure + t * answer;
        // A lost trial leaves all as it is.
        Moved {
            gap: if self.accepted { after } else { gap },
            pressure: if self.accepted { pushed } else { pressure },
            previous: projected_residual(&here),
        }
    }
}

/// The step, and the projected residual after it; `STORED` where that is a field.
struct UpdateState<const STORED: bool>;

impl<T, C, const STORED: bool, const READS: usize, const WRITES: usize>
    PointKernel<T, C, READS, WRITES, 6> for UpdateState<STORED>
where
    T: Real,
    C: GapConstraint<T>,
{
    #[inline(always)]
    fn at(numbers: &Numbers<T, C>, law: &impl Cohesion<T>, point: &mut Point<T, READS, WRITES, 6>) {
        let (direction, in_domain) = (point.reads[0], point.in_domain);
        // The kept step, where there is one, else the direction again.
        let way = [point.reads[READS - 1], point.line];
        let state = [point.writes[0], point.writes[1]];
        let moved = numbers.step_from(law, state, way, in_domain);
        // What is stored is of the state before the step.
        let previous = if STORED {
            point.writes[2]
        } else {
            moved.previous
        };
        let here = numbers.here_at(law, [moved.gap, moved.pressure], in_domain);
        let residual = projected_residual(&here);
        residual_terms(numbers, law, &here, in_domain).put(&mut point.terms);
        AlongSums {
            direction_change: direction * (residual - previous),
            direction_residual: direction * residual,
        }
        .put(&mut point.terms);
        point.writes[0] = moved.gap;
        point.writes[1] = moved.pressure;
        if STORED {
            point.writes[2] = residual;
        }
        point.writes[WRITES - 1] = previous;
        point.line = residual;
    }
}

/// Step 7, `plain::advance`, and step 1 of the next iteration: takes K s and steps, g += t s, p += t K s; then
/// fills the rows of a transform with the new projected residual, with the sums of the step's direction.
pub static UPDATE_STATE: [Kernel; 3] = [
    point_kernel!(
        update_state, InverseThenForward, gate Running, UpdateState over Unilateral [STORED = false],
        reads [direction], writes [gap, pressure, previous_residual], fresh 1,
        unbound [step, projected_residual], sums [ResidualSums, AlongSums]
    ),
    point_kernel!(
        update_state, InverseThenForward, gate Running, UpdateState over HardnessLimit [STORED = false],
        reads [direction], writes [gap, pressure, previous_residual], fresh 1,
        unbound [step, projected_residual], sums [ResidualSums, AlongSums]
    ),
    point_kernel!(
        update_state, InverseThenForward, gate Running, UpdateState over Smooth [STORED = false],
        reads [direction, step], writes [gap, pressure, previous_residual], fresh 1,
        unbound [projected_residual], sums [ResidualSums, AlongSums]
    ),
];

/// The same where the projected residual is stored for the levels of the preconditioner: that before the step is known.
pub static UPDATE_AND_STORE: [Kernel; 3] = [
    point_kernel!(
        update_state, Store, gate Running, UpdateState over Unilateral [STORED = true],
        reads [direction], writes [gap, pressure, projected_residual, previous_residual], fresh 1,
        unbound [step], sums [ResidualSums, AlongSums]
    ),
    point_kernel!(
        update_state, Store, gate Running, UpdateState over HardnessLimit [STORED = true],
        reads [direction], writes [gap, pressure, projected_residual, previous_residual], fresh 1,
        unbound [step], sums [ResidualSums, AlongSums]
    ),
    point_kernel!(
        update_state, Store, gate Running, UpdateState over Smooth [STORED = true],
        reads [direction, step], writes [gap, pressure, projected_residual, previous_residual], fresh 1,
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
) -> PressureSums<T> {
    // The mean pressure is what these terms are to give.
    let here = here_at(constraint, law, gap, pressure, in_domain);
    let traction = if in_domain {
        constraint.net_traction(&here)
    } else {
        here.pull
    };
    let y = pressure + traction;
    let weight = constraint.pressure_weight(&here);
    PressureSums {
        weighted_pressure: weight * y,
        pressure_weight: weight,
        least_pressure: y,
    }
}

/// The step, where the mean gap is prescribed.
struct Advance<const LINEAR: bool>;

impl<T, C, const LINEAR: bool, const READS: usize> PointKernel<T, C, READS, 3, 3>
    for Advance<LINEAR>
where
    T: Real,
    C: GapConstraint<T>,
{
    #[inline(always)]
    fn at(numbers: &Numbers<T, C>, law: &impl Cohesion<T>, point: &mut Point<T, READS, 3, 3>) {
        let ([gap, pressure, _], in_domain) = (point.writes, point.in_domain);
        let mut answer = point.line;
        if LINEAR {
            // K s from K s0 and K g, see `mean_gap`.
            let bent = pressure - point.reads[1];
            answer = answer + numbers.mean_gap_correction * (answer + bent);
        }
        let way = [point.reads[0], answer];
        let moved = numbers.step_from(law, [gap, pressure], way, in_domain);
        let state = [moved.gap, moved.pressure];
        balance_terms(&numbers.constraint, law, state, in_domain).put(&mut point.terms);
        point.writes = [moved.gap, moved.pressure, moved.previous];
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
struct Balance;

impl<T: Real, C: GapConstraint<T>> PointKernel<T, C, 2, 0, 3> for Balance {
    #[inline(always)]
    fn at(numbers: &Numbers<T, C>, law: &impl Cohesion<T>, point: &mut Point<T, 2, 0, 3>) {
        balance_terms(&numbers.constraint, law, point.reads, point.in_domain).put(&mut point.terms);
    }
}

point_kernels!(
    /// `plain::state`: the sums that give the mean pressure under a prescribed mean gap.
    BALANCE, balance, Sweep, gate Running, Balance [],
    reads [gap, pressure], writes [], sums [PressureSums]
);
