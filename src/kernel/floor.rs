//! What bounds the gap from below: a wall that never yields, or a solid that flows at its hardness.
//!
//! A solid that flows lets the gap go below zero, by the depth that it flows by, and holds it there
//! with a pressure that does not grow. The energy of a point then has a kink at zero: its slope is
//! `p + mean_pressure + sigma(0)` upwards and `p + mean_pressure - hardness` downwards. A point rests
//! at zero while the first is not negative and the second not positive; else it is free to the side
//! to which the energy falls. No step takes a point across zero.

use crate::kernel::Params;
use crate::law::Cohesion;
use crate::real::Real;

/// The balance of one point.
#[derive(Clone, Copy)]
pub struct Balance<T> {
    /// y: the slope of the energy to the side on which the point is or to which it may move. Of one
    /// that rests on a floor that flows it is 0.
    pub y: T,
    /// Whether it may move.
    pub free: bool,
}

/// The terms of the stopping measure at one point.
#[derive(Clone, Copy)]
pub struct Violation<T> {
    /// By how much pressure the point is out of balance.
    pub violation: T,
    /// Reaction of the floor to the solid and to the attraction.
    pub reaction: T,
    /// Attraction.
    pub traction: T,
}

/// A floor of the gap, point by point. `elastic` is p + mean_pressure.
pub trait Floor<T: Real>: Copy {
    /// The floor of a solve.
    fn of(params: &Params) -> Self;
    /// The balance of a point.
    fn balance(&self, law: &impl Cohesion<T>, gap: T, elastic: T) -> Balance<T>;
    /// What the point adds to the stopping measure.
    fn violation(
        &self,
        law: &impl Cohesion<T>,
        gap: T,
        elastic: T,
        stiffness_max: T,
    ) -> Violation<T>;
    /// Whether a closed point may only go down.
    fn goes_down(&self, gap: T, y: T) -> bool;
    /// The gap after a step: `[step, t, snap]`, of which t is taken; gaps below `snap` that a step
    /// closes are closed.
    fn land(&self, law: &impl Cohesion<T>, gap: T, y: T, step: [T; 3]) -> T;
    /// The weight of a point in the mean pressure that a held gap asks for.
    fn weight(&self, law: &impl Cohesion<T>, gap: T) -> T;
    /// Attraction at a gap on the side on which the point is, less the floor's pressure below zero.
    fn traction(&self, law: &impl Cohesion<T>, gap: T) -> T;
}

/// A wall at zero gap.
#[derive(Clone, Copy)]
pub struct Rigid;

impl<T: Real> Floor<T> for Rigid {
    #[inline(always)]
    fn of(_: &Params) -> Self {
        Rigid
    }

    #[inline(always)]
    fn balance(&self, law: &impl Cohesion<T>, gap: T, elastic: T) -> Balance<T> {
        let y = elastic + law.traction(gap);
        Balance {
            y,
            free: law.open(gap) > T::zero() || y < T::zero(),
        }
    }

    #[inline(always)]
    fn violation(
        &self,
        law: &impl Cohesion<T>,
        gap: T,
        elastic: T,
        stiffness_max: T,
    ) -> Violation<T> {
        let traction = law.traction(gap);
        let y = elastic + traction;
        let open = law.open(gap);
        Violation {
            violation: y.min(open * stiffness_max),
            reaction: law.weighed(reaction(open, y)),
            traction: law.weighed(traction),
        }
    }

    #[inline(always)]
    fn goes_down(&self, _gap: T, _y: T) -> bool {
        false
    }

    #[inline(always)]
    fn land(&self, law: &impl Cohesion<T>, gap: T, _y: T, [step, t, snap]: [T; 3]) -> T {
        // By what is left of the gap, which a cut makes exactly zero.
        let left = law.open(gap) + t * step;
        if left <= T::zero() || (step < T::zero() && left < snap) {
            law.floor()
        } else {
            gap + t * step
        }
    }

    #[inline(always)]
    fn weight(&self, law: &impl Cohesion<T>, gap: T) -> T {
        law.open(gap)
    }

    #[inline(always)]
    fn traction(&self, law: &impl Cohesion<T>, gap: T) -> T {
        law.traction(gap)
    }
}

/// A solid whose pressure saturates. Its unknown is the gap itself, never a part of it.
#[derive(Clone, Copy)]
pub struct Yielding<T> {
    /// The largest net pressure, reduced.
    hardness: T,
}

impl<T: Real> Floor<T> for Yielding<T> {
    #[inline(always)]
    fn of(params: &Params) -> Self {
        Yielding {
            hardness: T::of(params.hardness),
        }
    }

    #[inline(always)]
    fn balance(&self, law: &impl Cohesion<T>, gap: T, elastic: T) -> Balance<T> {
        let flow = elastic - self.hardness;
        if gap < T::zero() {
            return Balance {
                y: flow,
                free: true,
            };
        }
        let y = elastic + law.traction(gap);
        if gap > T::zero() || y < T::zero() {
            Balance { y, free: true }
        } else if flow > T::zero() {
            Balance {
                y: flow,
                free: true,
            }
        } else {
            Balance {
                y: T::zero(),
                free: false,
            }
        }
    }

    #[inline(always)]
    fn violation(
        &self,
        law: &impl Cohesion<T>,
        gap: T,
        elastic: T,
        stiffness_max: T,
    ) -> Violation<T> {
        let traction = law.traction(gap.max(T::zero()));
        let y = elastic + traction;
        // The middle one of the two slopes and the gap: 0 just where one of the three states is met.
        let violation = y.min(gap * stiffness_max).max(elastic - self.hardness);
        Violation {
            violation,
            reaction: reaction(gap, y),
            traction,
        }
    }

    #[inline(always)]
    fn goes_down(&self, gap: T, y: T) -> bool {
        // A closed point that is free and does not open has y of the flow, which is positive.
        gap < T::zero() || (gap == T::zero() && y > T::zero())
    }

    #[inline(always)]
    fn land(&self, _: &impl Cohesion<T>, gap: T, y: T, [step, t, snap]: [T; 3]) -> T {
        // No point crosses zero. What is no number stays none.
        let moved = gap + t * step;
        let lands = if self.goes_down(gap, y) {
            moved > T::zero() || (step > T::zero() && moved > -snap)
        } else {
            moved < T::zero() || (step < T::zero() && moved < snap)
        };
        if lands { T::zero() } else { moved }
    }

    #[inline(always)]
    fn weight(&self, _: &impl Cohesion<T>, gap: T) -> T {
        gap.abs()
    }

    #[inline(always)]
    fn traction(&self, law: &impl Cohesion<T>, gap: T) -> T {
        if gap < T::zero() {
            -self.hardness
        } else {
            law.traction(gap)
        }
    }
}

/// max(y, 0) where the point is closed.
#[inline(always)]
fn reaction<T: Real>(gap: T, y: T) -> T {
    if gap > T::zero() {
        T::zero()
    } else {
        y.max(T::zero())
    }
}

/// s = s0 + restore (g + s0) with s0 the way to clip(g + moved); below zero with the opposite sign of
/// `restore`, so that a held mean is kept on either side. `restore` is small and kept as itself, not
/// as a factor near one, which would cost it its digits.
#[inline(always)]
pub fn trial_step<T: Real>(open: T, moved: T, restore: T, down: bool) -> T {
    if down {
        let step = moved.min(-open);
        step - restore * (open + step)
    } else {
        let step = moved.max(-open);
        step + restore * (open + step)
    }
}
