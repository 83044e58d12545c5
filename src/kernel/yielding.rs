//! Kernels of a solid whose pressure saturates: those of the wall over a floor that flows, see
//! [`floor`](super::floor). A gap below zero is the depth that has flowed in this solve.

use super::floor::{Floor, Yielding, trial_step};
use super::points::{Made, Point, PointKernel};
use super::step::{Advance, Turn, TurnKept, Weighing};
use super::wall::{Descent, Directing, Free, FreeKept, Here, Trial, step_of, trial_terms};
use crate::kernel::{Params, Scalars, point_kernel};
use crate::law::Cohesion;
use crate::real::Real;

point_kernel!(
    /// The stopping measure of the present state. Reads gap, pressure.
    YIELD_RESIDUAL, yield_residual, Sweep, Free over Yielding by each_point_itself, reads 2, writes 0,
    sums [Add, Add, Min, Add], gate Always
);
point_kernel!(
    /// Loads yF and sums the stopping measure on the way. Reads gap, pressure.
    YIELD_FREE, yield_free, Load, Free over Yielding by each_point_itself, reads 2, writes 0,
    sums [Add, Add, Min, Add], gate Fresh
);
point_kernel!(
    /// As `yield_free`, and keeps yF in a field for the coarse level. Reads gap, pressure; writes yF.
    YIELD_FREE_KEPT, yield_free_kept, Load, FreeKept over Yielding by each_point_itself, reads 2, writes 1, fresh 1,
    sums [Add, Add, Min, Add], gate Fresh
);
point_kernel!(
    /// Keeps the preconditioned residual z on free points. Reads gap, pressure, the old yF.
    YIELD_DESCENT, yield_descent, Keep, Descent over Yielding by each_point_itself, reads 3, writes 0,
    sums [Add, Add], gate Ahead
);
point_kernel!(
    /// The same where the mean gap is held. Reads gap, pressure, the old yF, direction.
    YIELD_DESCENT_HELD, yield_descent_held, Keep, Descent over Yielding by each_point_itself, reads 4, writes 0,
    sums [Add, Add, Add, Add, Add, Add, Add, Add, Add], gate Ahead
);
point_kernel!(
    /// Turns the direction by the kept z and loads the trial step s. Reads gap, pressure; updates
    /// direction.
    YIELD_TRIAL, yield_trial, Resume, Trial over Yielding by each_point_itself, reads 2, writes 1,
    sums [Add, Min, Max, Min, Max], gate Running
);

/// The new direction, with what its trial step takes off the mean gap and how deep it goes.
#[derive(Clone, Copy)]
struct YieldDirect<T, F> {
    floor: F,
    mean: T,
    directing: Directing<T>,
    length: T,
}

impl<T: Real, F: Floor<T>> PointKernel<T, 2, 1, 3> for YieldDirect<T, F> {
    #[inline(always)]
    fn of(params: &Params, scalars: &Scalars) -> Self {
        YieldDirect {
            floor: F::of(params),
            mean: T::of(scalars.mean_pressure),
            directing: Directing::of(scalars),
            length: T::of(scalars.trial),
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 2, 1>) -> Made<T, 1, 3> {
        let ([gap, pressure], [direction]) = (point.reads, point.writes);
        let here = Here::at(
            &self.floor,
            law,
            gap,
            pressure + self.mean,
            point.on_surface,
        );
        let d = self.directing.turn(point.line, direction, here.free);
        let down = self.floor.goes_down(gap, here.y);
        let step = trial_step(gap, self.length * d, T::zero(), down);
        let depth = (-(gap + step)).most(T::zero());
        Made {
            writes: [d],
            line: point.line,
            terms: [step.double(), gap.double(), depth.double()],
        }
    }
}

point_kernel!(
    /// Turns the direction by the kept z and sums the trial step, the gap, and the depth of the trial
    /// (fixed mean gap). Reads gap, pressure; updates direction.
    YIELD_DIRECT, yield_direct, Peek, YieldDirect over Yielding by each_point_itself, reads 2, writes 1,
    sums [Add, Add, Add], gate Running
);

/// The trial step scaled back to the held mean gap, unless no scaling brings it back.
#[derive(Clone, Copy)]
struct YieldTrialHeld<T, F> {
    floor: F,
    mean: T,
    length: T,
    restore: T,
    /// Whether the trial is lost: one that moves and does not descend.
    lost: bool,
}

impl<T: Real, F: Floor<T>> PointKernel<T, 3, 0, 5> for YieldTrialHeld<T, F> {
    #[inline(always)]
    fn of(params: &Params, scalars: &Scalars) -> Self {
        YieldTrialHeld {
            floor: F::of(params),
            mean: T::of(scalars.mean_pressure),
            length: T::of(scalars.trial),
            restore: T::of(scalars.restore),
            lost: !(scalars.restore > -1.0 && scalars.restore < 1.0),
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 3, 0>) -> Made<T, 0, 5> {
        let [gap, pressure, direction] = point.reads;
        let on_surface = point.on_surface;
        let here = Here::at(&self.floor, law, gap, pressure + self.mean, on_surface);
        let way = [self.length * direction, self.restore];
        let (step, cut) = step_of(&self.floor, &here, way, on_surface);
        match self.lost {
            true => Made {
                writes: [],
                line: T::zero(),
                terms: [0.0, f64::INFINITY, 1.0, f64::INFINITY, 0.0],
            },
            false => Made {
                writes: [],
                line: step,
                terms: trial_terms(step, &here, cut, on_surface),
            },
        }
    }
}

point_kernel!(
    /// Loads the trial step scaled back to the held mean gap. Reads gap, pressure, direction.
    YIELD_TRIAL_HELD, yield_trial_held, Load, YieldTrialHeld over Yielding by each_point_itself, reads 3, writes 0,
    sums [Add, Min, Max, Min, Max], gate Running
);

/// What the step t does to the traction.
#[derive(Clone, Copy)]
struct YieldSearch<T, F> {
    floor: F,
    mean: T,
    length: T,
    restore: T,
    t: T,
}

impl<T: Real, F: Floor<T>> PointKernel<T, 3, 0, 1> for YieldSearch<T, F> {
    #[inline(always)]
    fn of(params: &Params, scalars: &Scalars) -> Self {
        YieldSearch {
            floor: F::of(params),
            mean: T::of(scalars.mean_pressure),
            length: T::of(scalars.trial),
            restore: T::of(scalars.restore),
            t: T::of(scalars.step),
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 3, 0>) -> Made<T, 0, 1> {
        let [gap, direction, pressure] = point.reads;
        let here = Here::at(
            &self.floor,
            law,
            gap,
            pressure + self.mean,
            point.on_surface,
        );
        let step = trial_step(gap, self.length * direction, self.restore, false);
        let change = law.change(gap, self.t * step).double() * step.double();
        // Below zero the pressure does not change.
        let counts = point.on_surface & !self.floor.goes_down(gap, here.y);
        Made {
            writes: [],
            line: point.line,
            terms: [if counts { change } else { 0.0 }],
        }
    }
}

point_kernel!(
    /// Sums `<sigma(g + t s) - sigma(g), s>`. Reads gap, direction, pressure.
    YIELD_SEARCH, yield_search, Sweep, YieldSearch over Yielding by each_point_itself, reads 3, writes 0,
    sums [Add], gate Searching
);
point_kernel!(
    /// Takes K s and steps, then loads the new yF. Reads direction; updates gap, pressure; writes the
    /// old yF.
    YIELD_TURN, yield_turn, Turn, Turn over Yielding by each_point_itself, reads 1, writes 3, fresh 1,
    sums [Add, Add, Min, Add, Add, Add], gate Running
);
point_kernel!(
    /// As `yield_turn`, and keeps the new yF in a field for the coarse level. Writes it after the others.
    YIELD_TURN_KEPT, yield_turn_kept, Turn, TurnKept over Yielding by each_point_itself, reads 1, writes 4, fresh 2,
    sums [Add, Add, Min, Add, Add, Add], gate Running
);
point_kernel!(
    /// Takes K s and steps, where the mean gap is held; sums as `yield_balance`. Reads direction; updates
    /// gap, pressure; writes the old yF.
    YIELD_ADVANCE, yield_advance, Store, Advance over Yielding by each_point_itself, reads 1, writes 3, fresh 1,
    sums [Add, Add, Min], gate Running
);
point_kernel!(
    /// The sums that give the mean pressure under a held mean gap. Reads gap, pressure.
    YIELD_BALANCE, yield_balance, Sweep, Weighing over Yielding by each_point_itself, reads 2, writes 0,
    sums [Add, Add, Min], gate Running
);
