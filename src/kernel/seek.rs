//! The search for the gap at a value of the iteration's variable, for several points together.
//!
//! It takes repetitions, so that no kernel over points can make it at each point for itself and stay without
//! branches. Points next to each other take each step side by side, and one that has arrived stays where it is: what is found
//! does not depend on the others.

use crate::law::Cohesion;
use crate::real::Real;

/// Points that are sought together: those that need it lie side by side, and each waits for the others.
pub(super) const SOUGHT: usize = 16;
/// Largest number of steps of a search.
const MOST_STEPS: usize = 25;

/// A gap that is sought at a value of the iteration's variable.
#[derive(Clone, Copy)]
pub struct Sought<T> {
    /// The value.
    pub goal: T,
    /// The gap as it stands.
    pub gap: T,
    /// It is not less.
    pub bound: T,
    /// By how much the last step towards it was longer than one after which no other is needed.
    pub left: T,
}

/// The variable of the iteration beside the gap: the gap itself, unless a constraint says otherwise.
pub trait Variable<T: Real>: Copy {
    /// The iteration's variable after a move along the direction.
    #[inline(always)]
    fn goal(&self, _law: &impl Cohesion<T>, gap: T, moved: T) -> T {
        gap + moved
    }
    /// Whether the gap at a value of the iteration's variable is another number and is to be sought.
    #[inline(always)]
    fn is_bent(&self, _goal: T) -> bool {
        false
    }
    /// The beginning of that search, from the gap before the move.
    #[inline(always)]
    fn sought(&self, _law: &impl Cohesion<T>, goal: T, gap: T) -> Sought<T> {
        Sought {
            goal,
            gap,
            bound: gap,
            left: T::zero(),
        }
    }
    /// Whether the beginning of a search from a gap is so far from it that it is to be bounded.
    #[inline(always)]
    fn is_far(&self, _sought: &Sought<T>, _gap: T) -> bool {
        false
    }
    /// That beginning within a bound, if it is far.
    #[inline(always)]
    fn bounded(&self, _law: &impl Cohesion<T>, sought: Sought<T>, _gap: T) -> Sought<T> {
        sought
    }
    /// Whether after such a last step another one is needed.
    #[inline(always)]
    fn is_open(&self, _left: T) -> bool {
        false
    }
    /// One step of the search; none where it is over.
    #[inline(always)]
    fn nearer(&self, _law: &impl Cohesion<T>, sought: Sought<T>) -> Sought<T> {
        sought
    }
}

/// Puts the gap in the place of each goal, from the gaps before the move.
#[allow(
    clippy::needless_range_loop,
    reason = "iterators and closures would be compiled with each kernel, law and number"
)]
#[inline(always)]
pub(super) fn gap_at<T, C, L>(
    constraint: &C,
    law: impl Fn(usize) -> L,
    gaps: &[T; SOUGHT],
    goals: &mut [T; SOUGHT],
) where
    T: Real,
    C: Variable<T>,
    L: Cohesion<T>,
{
    let mut bent = false;
    for place in 0..SOUGHT {
        bent |= constraint.is_bent(goals[place]);
    }
    // Most points are away from the repulsion, where the variable is the gap.
    if !bent {
        return;
    }
    let (mut found, mut bounds) = ([T::zero(); SOUGHT], [T::zero(); SOUGHT]);
    let mut left = [T::zero(); SOUGHT];
    let mut far = false;
    for place in 0..SOUGHT {
        let sought = constraint.sought(&law(place), goals[place], gaps[place]);
        found[place] = sought.gap;
        bounds[place] = sought.bound;
        left[place] = sought.left;
        far |= constraint.is_far(&sought, gaps[place]);
    }
    let present = |place: usize, found: &[T], bounds: &[T], left: &[T]| Sought {
        goal: goals[place],
        gap: found[place],
        bound: bounds[place],
        left: left[place],
    };
    if far {
        for place in 0..SOUGHT {
            let sought = present(place, &found, &bounds, &left);
            let bounded = constraint.bounded(&law(place), sought, gaps[place]);
            found[place] = bounded.gap;
            bounds[place] = bounded.bound;
        }
    }
    for _ in 0..MOST_STEPS {
        let mut open = false;
        for place in 0..SOUGHT {
            open |= constraint.is_open(left[place]);
        }
        if !open {
            break;
        }
        for place in 0..SOUGHT {
            let sought = present(place, &found, &bounds, &left);
            let nearer = constraint.nearer(&law(place), sought);
            found[place] = nearer.gap;
            left[place] = nearer.left;
        }
    }
    *goals = found;
}
