//! The search for the step length along a trial step, point by point and without transforms.

use super::constraint::{GapConstraint, HardnessLimit, Move, Unilateral};
use super::points::{Numbers, Point, PointKernel};
use super::smooth::Smooth;
use super::sums::sum_group;
use super::{Kernel, point_kernel};
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

/// Change of the traction after t of a step, times it, at a point that counts. A function of its own, and not a closure, which
/// the compiler would call point by point where the law is long.
#[inline(always)]
fn change_along<T: Real>(law: &impl Cohesion<T>, [gap, step]: [T; 2], t: T, counts: bool) -> T {
    let change = law.change(gap, t * step) * step;
    if counts { change } else { T::zero() }
}

impl<T: Real, C: GapConstraint<T>> Numbers<T, C> {
    /// Change of the traction along a step at each length tried, at a point that counts. Written out, since
    /// the compiler makes no vectors of a loop in here.
    #[inline(always)]
    fn changes(&self, law: &impl Cohesion<T>, gap: T, step: T, counts: bool) -> ChangeSums<T> {
        let [first, second, third, fourth] = self.tried;
        ChangeSums {
            change_at_first: change_along(law, [gap, step], first, counts),
            change_at_second: change_along(law, [gap, step], second, counts),
            change_at_third: change_along(law, [gap, step], third, counts),
            change_at_fourth: change_along(law, [gap, step], fourth, counts),
        }
    }

    /// Change of traction and energy of a smooth law.
    #[inline(always)]
    fn energies(&self, law: &impl Cohesion<T>, gap: T, step: T) -> EnergySums<T> {
        let moved = self.step * step;
        let [energy, size] = law.energy_change(gap, moved);
        EnergySums {
            change_at_first: law.change(gap, moved) * step,
            energy_change: energy,
            energy_size: size,
        }
    }
}

/// Change of the traction at each step length that one line-search pass tries; of a smooth law at one, with
/// that of the energy.
struct Search;

impl<T, C, const READS: usize, const TERMS: usize> PointKernel<T, C, READS, 0, TERMS> for Search
where
    T: Real,
    C: GapConstraint<T>,
{
    /// A pad has no law: most points of a free boundary are spared.
    const SURFACE_ALONE: bool = true;

    #[inline(always)]
    fn at(numbers: &Numbers<T, C>, law: &impl Cohesion<T>, point: &mut Point<T, READS, 0, TERMS>) {
        let (gap, moved) = (point.reads[0], point.reads[1]);
        if C::STORES_STEP {
            let energies = numbers.energies(law, gap, moved);
            energies.put(&mut point.terms);
        } else {
            // To which side a closed point may move is told by its pressure, where there are two.
            let pressure = if READS > 2 { point.reads[2] } else { T::zero() };
            let here = numbers.here_at(law, [gap, pressure], true);
            let (constraint, correction) = (&numbers.constraint, numbers.mean_gap_correction);
            let way = Move {
                moved: numbers.trial_length * moved,
                correction,
                found: gap,
            };
            let step = constraint.trial_step(law, &here, way).step;
            // Below zero the pressure does not change.
            let counts = !constraint.goes_down(gap, here.y);
            let changes = numbers.changes(law, gap, step, counts);
            changes.put(&mut point.terms);
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
