//! Kernels that take the stopping measure of the present state.

use super::constraint::{GapConstraint, HardnessLimit, Here, Unilateral, projected_residual};
use super::points::{Numbers, Point, PointKernel};
use super::smooth::Smooth;
use super::sums::sum_group;
use super::{point_kernel, point_kernels};
use crate::law::Cohesion;
use crate::real::Real;

sum_group! {
    /// The stopping measure.
    ResidualSums { violation, pressures, least_gap, gap_squares }
}

/// The terms of the stopping measure at one point.
#[inline(always)]
pub(super) fn residual_terms<T: Real>(
    numbers: &Numbers<T, impl GapConstraint<T>>,
    law: &impl Cohesion<T>,
    here: &Here<T>,
    in_domain: bool,
) -> ResidualSums<T> {
    if !in_domain {
        return ResidualSums {
            violation: here.y * here.y,
            pressures: T::zero(),
            least_gap: T::infinity(),
            gap_squares: T::zero(),
        };
    }
    let found = numbers.constraint.violation(here, numbers.stiffness_max);
    let reaction = law.weighed(found.reaction);
    let traction = law.weighed(found.traction);
    ResidualSums {
        violation: found.violation * found.violation,
        pressures: reaction * reaction + traction * traction,
        least_gap: here.open,
        gap_squares: here.gap * here.gap,
    }
}

/// The stopping measure, and the projected residual on the way.
pub(super) struct Residual;

impl<T: Real, C: GapConstraint<T>, const WRITES: usize> PointKernel<T, C, 2, WRITES, 4>
    for Residual
{
    #[inline(always)]
    fn at(numbers: &Numbers<T, C>, law: &impl Cohesion<T>, point: &mut Point<T, 2, WRITES, 4>) {
        let here = numbers.here_at(law, point.reads, point.in_domain);
        residual_terms(numbers, law, &here, point.in_domain).put(&mut point.terms);
        point.line = projected_residual(&here);
        // Where it is kept, it is the one field written.
        point.writes = [point.line; WRITES];
    }
}

point_kernels!(
    /// The stopping measure of the present state, `plain::state`.
    RESIDUAL, residual, Sweep, gate Always, Residual [],
    reads [gap, pressure], writes [], sums [ResidualSums]
);
point_kernels!(
    /// Step 1, `plain::state`: fills the rows of a transform
    /// with the projected residual and takes the stopping measure on the way.
    LOAD_RESIDUAL, load_residual, Load, gate Fresh, Residual [],
    reads [gap, pressure], writes [], unbound [projected_residual], sums [ResidualSums]
);
point_kernels!(
    /// The same, which stores the projected residual for the levels of the preconditioner.
    STORE_RESIDUAL, load_residual, Sweep, gate Fresh, Residual [],
    reads [gap, pressure], writes [projected_residual], fresh 1, sums [ResidualSums]
);
