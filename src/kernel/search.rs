//! The search for the step length along a trial step, point by point and without transforms.

use super::constraint::{GapConstraint, HardnessLimit, Unilateral, here_at};
use super::points::{Made, Point, PointKernel};
use super::smooth::Smooth;
use super::sums::sum_group;
use super::{Kernel, Params, Scalars, TRIED, point_kernel};
use crate::law::Cohesion;
use crate::real::Real;

sum_group! {
    /// Change of the traction along the step at each step length that one pass tries.
    ChangeSums { change_at_first, change_at_second, change_at_third, change_at_fourth }
}
sum_group! {
    /// Change of traction and energy at one step length.
    EnergySums { change_at_first, energy_change, energy_size }
}

/// What the step lengths that one line-search pass tries change of the traction, of a smooth law of the energy.
#[derive(Clone, Copy)]
struct Search<T, C> {
    constraint: C,
    mean_pressure: T,
    trial_length: T,
    correction: T,
    step: T,
    tried: [T; TRIED],
}

impl<T: Real, C: GapConstraint<T>> Search<T, C> {
    /// Change of the traction along a step at each length tried, at a point that counts. Written out, since
    /// the compiler makes no vectors of a loop in here.
    #[inline(always)]
    fn changes(&self, law: &impl Cohesion<T>, gap: T, step: T, counts: bool) -> ChangeSums {
        let change = |t: T| {
            let change = law.change(gap, t * step).double() * step.double();
            if counts { change } else { 0.0 }
        };
        let [first, second, third, fourth] = self.tried;
        ChangeSums {
            change_at_first: change(first),
            change_at_second: change(second),
            change_at_third: change(third),
            change_at_fourth: change(fourth),
        }
    }

    /// Change of traction and energy of a smooth law.
    #[inline(always)]
    fn energies(&self, law: &impl Cohesion<T>, gap: T, step: T) -> EnergySums {
        let moved = self.step * step;
        let [energy, size] = law.energy_change(gap, moved);
        EnergySums {
            change_at_first: law.change(gap, moved).double() * step.double(),
            energy_change: energy.double(),
            energy_size: size.double(),
        }
    }
}

impl<T, C, const READS: usize, const TERMS: usize> PointKernel<T, READS, 0, TERMS> for Search<T, C>
where
    T: Real,
    C: GapConstraint<T>,
{
    #[inline(always)]
    fn new(params: &Params, scalars: &Scalars) -> Self {
        Search {
            constraint: C::new(params),
            mean_pressure: T::of(scalars.mean_pressure),
            trial_length: T::of(scalars.trial_length),
            correction: T::of(scalars.mean_gap_correction),
            step: T::of(scalars.step),
            tried: scalars.tried.map(T::of),
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, READS, 0>) -> Made<T, 0, TERMS> {
        let (gap, moved, in_domain) = (point.reads[0], point.reads[1], point.in_domain);
        let mut terms = [0.0; TERMS];
        if C::STORES_STEP {
            // A pad has no law: most points of a free boundary are spared its powers.
            if in_domain {
                self.energies(law, gap, moved).put(&mut terms);
            }
        } else {
            // To which side a closed point may move is told by its pressure, where there are two.
            let pressure = if READS > 2 { point.reads[2] } else { T::zero() };
            let elastic = pressure + self.mean_pressure;
            let here = here_at(&self.constraint, law, gap, elastic, in_domain);
            let moved = self.trial_length * moved;
            let step = self
                .constraint
                .trial_step(law, &here, moved, self.correction)
                .step;
            // Below zero the pressure does not change.
            let counts = in_domain & !self.constraint.goes_down(gap, here.y);
            self.changes(law, gap, step, counts).put(&mut terms);
        }
        Made {
            writes: [],
            line: point.line,
            terms,
        }
    }
}

/// Step 6, `plain::slope_at`: sums `<sigma(g + t s) - sigma(g), s>` of each t that a pass tries.
pub static SEARCH: [Kernel; 3] = [
    point_kernel!(
        search, Sweep, gate Searching, Search over Unilateral [],
        reads [gap, direction], writes [], unbound [pressure, step], sums [ChangeSums]
    ),
    point_kernel!(
        search, Sweep, gate Searching, Search over HardnessLimit [],
        reads [gap, direction, pressure], writes [], unbound [step], sums [ChangeSums]
    ),
    point_kernel!(
        search, Sweep, gate Searching, Search over Smooth [],
        reads [gap, step], writes [], unbound [pressure, direction], sums [EnergySums]
    ),
];
