//! The preconditioned residual z, from which the direction is made.

use super::constraint::{GapConstraint, HardnessLimit, Unilateral, projected_residual};
use super::points::{Numbers, Point, PointKernel};
use super::smooth::Smooth;
use super::sums::sum_group;
use super::{point_kernel, point_kernels};
use crate::law::Cohesion;
use crate::real::Real;

sum_group! {
    /// What beta is made of.
    DescentSums { z_residual, z_change }
}
sum_group! {
    /// What the direction adds to it, and what takes the means off, under a prescribed mean gap.
    MeanGapDescentSums after DescentSums {
        direction_change, direction_residual, weighted_z, free_weight, free_residual, free_change,
        weighted_direction,
    }
}

/// The terms of beta: of z, the projected residual and the one before it.
#[inline(always)]
pub(super) fn descent_terms<T: Real>(z: T, residual: T, previous: T) -> DescentSums<T> {
    DescentSums {
        z_residual: z * residual,
        z_change: z * (residual - previous),
    }
}

/// Those that the direction enters too, in the measure `weight` of the free points.
#[inline(always)]
pub(super) fn mean_gap_descent_terms<T: Real>(
    [z, r, previous, d, w]: [T; 5],
    free: bool,
) -> MeanGapDescentSums<T> {
    let change = r - previous;
    let on_free = |term: T| if free { term } else { T::zero() };
    MeanGapDescentSums {
        direction_change: d * change,
        direction_residual: on_free(d * r),
        weighted_z: on_free(w * z),
        free_weight: on_free(w),
        free_residual: on_free(r),
        free_change: on_free(change),
        weighted_direction: on_free(w * d),
    }
}

/// The preconditioned residual z on free points; `MEAN_GAP` where that is prescribed.
pub(super) struct Descent<const MEAN_GAP: bool>;

impl<T, C, const MEAN_GAP: bool, const READS: usize, const TERMS: usize>
    PointKernel<T, C, READS, 0, TERMS> for Descent<MEAN_GAP>
where
    T: Real,
    C: GapConstraint<T>,
{
    #[inline(always)]
    fn at(numbers: &Numbers<T, C>, law: &impl Cohesion<T>, point: &mut Point<T, READS, 0, TERMS>) {
        let [gap, pressure, previous] = [point.reads[0], point.reads[1], point.reads[2]];
        let here = numbers.here_at(law, [gap, pressure], point.in_domain);
        let residual = projected_residual(&here);
        let z = numbers.constraint.preconditioned(&here, point.line);
        descent_terms(z, residual, previous).put(&mut point.terms);
        if MEAN_GAP {
            let direction = point.reads[3];
            mean_gap_descent_terms([z, residual, previous, direction, here.weight], here.free)
                .put(&mut point.terms);
        }
        point.line = z;
    }
}

point_kernels!(
    /// Step 2, the end of `plain::precondition` without levels: retains the rows of z. Its sums are those of step 3.
    DESCENT, descent, RetainRows, gate Ahead, Descent [MEAN_GAP = false],
    reads [gap, pressure, previous_residual], writes [], unbound [direction], sums [DescentSums]
);
point_kernels!(
    /// The same under a prescribed mean gap, `plain::project`.
    MEAN_GAP_DESCENT, descent, RetainRows, gate Ahead, Descent [MEAN_GAP = true],
    reads [gap, pressure, previous_residual, direction], writes [], sums [DescentSums, MeanGapDescentSums]
);
