//! What bounds the gap from below: a wall that never yields, or a solid that flows at its hardness.
//!
//! A solid that flows lets the gap go below zero, by the depth that it flows by, and holds it there
//! with a pressure that does not grow. The energy of a point then has a kink at zero: its slope is
//! `p + mean_pressure + sigma(0)` upwards and `p + mean_pressure - hardness` downwards. A point rests
//! at zero while the first is not negative and the second not positive; else it is free to the side
//! to which the energy falls. No step takes a point across zero.

use std::marker::PhantomData;

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

/// A point of the surface as its floor sees it.
#[derive(Clone, Copy)]
pub struct State<T> {
    /// The unknown: the gap, or its correction.
    pub gap: T,
    /// The gap itself.
    pub open: T,
    /// p + mean_pressure.
    pub elastic: T,
    /// Attraction at the gap, or at zero for a gap below it.
    pub pull: T,
}

/// A floor of the gap, point by point.
pub trait Floor<T: Real>: Copy {
    /// The floor of a solve.
    fn of(params: &Params) -> Self;
    /// A point, at which the law is looked at once.
    fn state(&self, law: &impl Cohesion<T>, gap: T, elastic: T) -> State<T>;
    /// The balance of a point.
    fn balance(&self, here: &State<T>) -> Balance<T>;
    /// What the point adds to the stopping measure.
    fn violation(&self, here: &State<T>, stiffness_max: T) -> Violation<T>;
    /// Whether a closed point may only go down, of its open gap and y.
    fn goes_down(&self, open: T, y: T) -> bool;
    /// The gap after a step: `[step, t, snap]`, of which t is taken; gaps below `snap` that a step
    /// closes are closed, at the unknown `closed`.
    fn land(&self, here: &State<T>, y: T, step: [T; 3], closed: T) -> T;
    /// The weight of a point in the mean pressure that a held gap asks for.
    fn weight(&self, here: &State<T>) -> T;
    /// Attraction at a gap on the side on which the point is, less the floor's pressure below zero.
    fn traction(&self, here: &State<T>) -> T;
}

/// A wall at zero gap.
#[derive(Clone, Copy)]
pub struct Rigid<T>(PhantomData<T>);

impl<T: Real> Floor<T> for Rigid<T> {
    #[inline(always)]
    fn of(_: &Params) -> Self {
        Rigid(PhantomData)
    }

    #[inline(always)]
    fn state(&self, law: &impl Cohesion<T>, gap: T, elastic: T) -> State<T> {
        State {
            gap,
            open: law.open(gap),
            elastic,
            pull: law.traction(gap),
        }
    }

    #[inline(always)]
    fn balance(&self, here: &State<T>) -> Balance<T> {
        let y = here.elastic + here.pull;
        Balance {
            y,
            free: (here.open > T::zero()) | (y < T::zero()),
        }
    }

    #[inline(always)]
    fn violation(&self, here: &State<T>, stiffness_max: T) -> Violation<T> {
        let y = here.elastic + here.pull;
        Violation {
            violation: y.least(here.open * stiffness_max),
            reaction: reaction(here.open, y),
            traction: here.pull,
        }
    }

    #[inline(always)]
    fn goes_down(&self, _: T, _: T) -> bool {
        false
    }

    #[inline(always)]
    fn land(&self, here: &State<T>, _: T, [step, t, snap]: [T; 3], closed: T) -> T {
        // By what is left of the gap, which a cut makes exactly zero.
        let left = here.open + t * step;
        let lands = (left <= T::zero()) | ((step < T::zero()) & (left < snap));
        if lands { closed } else { here.gap + t * step }
    }

    #[inline(always)]
    fn weight(&self, here: &State<T>) -> T {
        here.open
    }

    #[inline(always)]
    fn traction(&self, here: &State<T>) -> T {
        here.pull
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
    fn state(&self, law: &impl Cohesion<T>, gap: T, elastic: T) -> State<T> {
        State {
            gap,
            open: gap,
            elastic,
            pull: law.traction(gap.most(T::zero())),
        }
    }

    #[inline(always)]
    fn balance(&self, here: &State<T>) -> Balance<T> {
        let flow = here.elastic - self.hardness;
        let y = here.elastic + here.pull;
        let below = here.gap < T::zero();
        let above = (here.gap > T::zero()) | (y < T::zero());
        let flows = below | (!above & (flow > T::zero()));
        let rests = if above { y } else { T::zero() };
        Balance {
            y: if flows { flow } else { rests },
            free: flows | above,
        }
    }

    #[inline(always)]
    fn violation(&self, here: &State<T>, stiffness_max: T) -> Violation<T> {
        let y = here.elastic + here.pull;
        let open = here.gap * stiffness_max;
        // The middle one of the two slopes and the gap: 0 just where one of the three states is met.
        let violation = y.least(open).most(here.elastic - self.hardness);
        Violation {
            violation,
            reaction: reaction(here.gap, y),
            traction: here.pull,
        }
    }

    #[inline(always)]
    fn goes_down(&self, gap: T, y: T) -> bool {
        // A closed point that is free and does not open has y of the flow, which is positive.
        (gap < T::zero()) | ((gap == T::zero()) & (y > T::zero()))
    }

    #[inline(always)]
    fn land(&self, here: &State<T>, y: T, [step, t, snap]: [T; 3], closed: T) -> T {
        // No point crosses zero. What is no number stays none.
        let moved = here.gap + t * step;
        let lands = if self.goes_down(here.gap, y) {
            (moved > T::zero()) | ((step > T::zero()) & (moved > -snap))
        } else {
            (moved < T::zero()) | ((step < T::zero()) & (moved < snap))
        };
        if lands { closed } else { moved }
    }

    #[inline(always)]
    fn weight(&self, here: &State<T>) -> T {
        here.gap.abs()
    }

    #[inline(always)]
    fn traction(&self, here: &State<T>) -> T {
        if here.gap < T::zero() {
            -self.hardness
        } else {
            here.pull
        }
    }
}

/// max(y, 0) where the point is closed.
#[inline(always)]
fn reaction<T: Real>(open: T, y: T) -> T {
    if open > T::zero() {
        T::zero()
    } else {
        y.most(T::zero())
    }
}

/// s = s0 + restore (g + s0) with s0 the way to clip(g + moved); below zero with the opposite sign of
/// `restore`, so that a held mean is kept on either side. `restore` is small and kept as itself, not
/// as a factor near one, which would cost it its digits.
#[inline(always)]
pub fn trial_step<T: Real>(open: T, moved: T, restore: T, down: bool) -> T {
    if down {
        let step = moved.least(-open);
        step - restore * (open + step)
    } else {
        let step = moved.most(-open);
        step + restore * (open + step)
    }
}
