//! Kernels that take the stopping measure of the present state.

use super::constraint::{
    GapConstraint, HardnessLimit, Here, Unilateral, here_at, projected_residual,
};
use super::points::{Made, Point, PointKernel};
use super::smooth::Smooth;
use super::sums::sum_group;
use super::{Params, Scalars, point_kernel, point_kernels};
use crate::law::Cohesion;
use crate::real::Real;

sum_group! {
    /// The stopping measure.
    ResidualSums { violation, pressures, least_gap, gap_squares }
}

/// The terms of the stopping measure at one point, with the largest stiffness.
#[inline(always)]
pub(super) fn residual_terms<T: Real>(
    constraint: &impl GapConstraint<T>,
    law: &impl Cohesion<T>,
    here: &Here<T>,
    stiffness_max: T,
    in_domain: bool,
) -> ResidualSums {
    if !in_domain {
        let y = here.y.double();
        return ResidualSums {
            violation: y * y,
            pressures: 0.0,
            least_gap: f64::INFINITY,
            gap_squares: 0.0,
        };
    }
    let found = constraint.violation(here, stiffness_max);
    let violation = found.violation.double();
    let reaction = law.weighed(found.reaction).double();
    let traction = law.weighed(found.traction).double();
    let gap = here.gap.double();
    ResidualSums {
        violation: violation * violation,
        pressures: reaction * reaction + traction * traction,
        least_gap: here.open.double(),
        gap_squares: gap * gap,
    }
}

/// The stopping measure, and the projected residual on the way.
#[derive(Clone, Copy)]
pub(super) struct Residual<T, C> {
    constraint: C,
    mean_pressure: T,
    stiffness_max: T,
}

impl<T: Real, C: GapConstraint<T>, const WRITES: usize> PointKernel<T, 2, WRITES, 4>
    for Residual<T, C>
{
    #[inline(always)]
    fn new(params: &Params, scalars: &Scalars) -> Self {
        Residual {
            constraint: C::new(params),
            mean_pressure: T::of(scalars.mean_pressure),
            stiffness_max: T::of(params.stiffness_max),
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 2, WRITES>) -> Made<T, WRITES, 4> {
        let ([gap, pressure], in_domain) = (point.reads, point.in_domain);
        let elastic = pressure + self.mean_pressure;
        let here = here_at(&self.constraint, law, gap, elastic, in_domain);
        let residual = projected_residual(&here);
        let mut terms = [0.0; 4];
        residual_terms(&self.constraint, law, &here, self.stiffness_max, in_domain).put(&mut terms);
        Made {
            // Where it is kept, it is the one field written.
            writes: [residual; WRITES],
            line: residual,
            terms,
        }
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
