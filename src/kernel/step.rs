//! Kernels that take the step along a direction, and with it the balance or the residual that follows.
//!
//! They are those of a wall and, by their floor, of a solid that flows. Notation as in
//! [`wall`](super::wall).

use std::marker::PhantomData;

use super::floor::{Floor, Rigid};
use super::points::{Made, Point, PointKernel};
use super::wall::{Here, residual_terms, step_of};
use crate::kernel::{Params, Scalars, point_kernel};
use crate::law::Cohesion;
use crate::real::Real;

/// What a step is made of, from the scalars.
#[derive(Clone, Copy)]
struct Step<T> {
    /// Whether there is one: a lost trial leaves all as it is.
    taken: bool,
    mean: T,
    trial: T,
    restore: T,
    length: T,
    snap: T,
}

impl<T: Real> Step<T> {
    #[inline(always)]
    fn of(scalars: &Scalars) -> Self {
        Step {
            taken: scalars.accepted,
            mean: T::of(scalars.mean_pressure),
            trial: T::of(scalars.trial),
            restore: T::of(scalars.restore),
            length: T::of(scalars.step),
            snap: T::of(scalars.snap),
        }
    }

    /// Gap and pressure of a point after the step along a direction, which the elastic pressure answers;
    /// and y on free points before it.
    #[inline(always)]
    fn take(
        &self,
        floor: &impl Floor<T>,
        law: &impl Cohesion<T>,
        [gap, pressure]: [T; 2],
        [direction, answer]: [T; 2],
        on_surface: bool,
    ) -> [T; 3] {
        let here = Here::at(floor, law, gap, pressure + self.mean, on_surface);
        let way = [self.trial * direction, self.restore];
        let (step, _) = step_of(floor, &here, way, on_surface);
        let moved = match on_surface {
            true => {
                let step = [step, self.length, self.snap];
                floor.land(&here.state, here.y, step, law.floor())
            }
            false => gap + self.length * step,
        };
        let pushed = pressure + self.length * answer;
        let before = here.y_free();
        match self.taken {
            true => [moved, pushed, before],
            false => [gap, pressure, before],
        }
    }
}

/// The step, and the free residual after it.
#[derive(Clone, Copy)]
pub(super) struct Turn<T, F> {
    floor: F,
    step: Step<T>,
    stiffness_max: T,
}

impl<T: Real, F: Floor<T>> PointKernel<T, 1, 3, 6> for Turn<T, F> {
    #[inline(always)]
    fn of(params: &Params, scalars: &Scalars) -> Self {
        Turn {
            floor: F::of(params),
            step: Step::of(scalars),
            stiffness_max: T::of(params.stiffness_max),
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 1, 3>) -> Made<T, 3, 6> {
        let ([direction], [gap, pressure, _]) = (point.reads, point.writes);
        let on_surface = point.on_surface;
        let way = [direction, point.line];
        let [gap, pressure, before] =
            self.step
                .take(&self.floor, law, [gap, pressure], way, on_surface);
        let here = Here::at(&self.floor, law, gap, pressure + self.step.mean, on_surface);
        let [violation, pressures, least, gaps] =
            residual_terms(&self.floor, law, &here, self.stiffness_max, on_surface);
        let (d, y) = (direction.double(), here.y_free());
        let change = d * (y.double() - before.double());
        Made {
            writes: [gap, pressure, before],
            line: y,
            terms: [violation, pressures, least, gaps, change, d * y.double()],
        }
    }
}

point_kernel!(
    /// Takes K s and steps: g += t s, p += t K s; then loads the new yF, as `wall_free` does, with the
    /// sums of the step's direction. Reads direction; updates gap, pressure; writes the old yF.
    WALL_TURN, wall_turn, Turn, Turn over Rigid by each_point, reads 1, writes 3, fresh 1,
    sums [Add, Add, Min, Add, Add, Add], gate Running
);

/// The same, which keeps the free residual in a field.
#[derive(Clone, Copy)]
pub(super) struct TurnKept<T, F>(Turn<T, F>);

impl<T: Real, F: Floor<T>> PointKernel<T, 1, 4, 6> for TurnKept<T, F> {
    #[inline(always)]
    fn of(params: &Params, scalars: &Scalars) -> Self {
        TurnKept(Turn::of(params, scalars))
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 1, 4>) -> Made<T, 4, 6> {
        let [gap, pressure, before, _] = point.writes;
        let made = self.0.at(
            law,
            Point {
                reads: point.reads,
                writes: [gap, pressure, before],
                line: point.line,
                on_surface: point.on_surface,
            },
        );
        let [gap, pressure, before] = made.writes;
        Made {
            writes: [gap, pressure, before, made.line],
            line: made.line,
            terms: made.terms,
        }
    }
}

point_kernel!(
    /// As `wall_turn`, and keeps the new yF in a field for the coarse level. Writes it after the others.
    WALL_TURN_KEPT, wall_turn_kept, Turn, TurnKept over Rigid by each_point, reads 1, writes 4, fresh 2,
    sums [Add, Add, Min, Add, Add, Add], gate Running
);

/// The terms of the mean pressure that a held gap asks for.
#[inline(always)]
fn balance_terms<T: Real>(
    floor: &impl Floor<T>,
    law: &impl Cohesion<T>,
    [gap, pressure]: [T; 2],
    on_surface: bool,
) -> [f64; 3] {
    // The mean pressure is what these terms are to give.
    let state = Here::at(floor, law, gap, pressure, on_surface).state;
    let traction = match on_surface {
        true => floor.traction(&state),
        false => state.pull,
    };
    let y = (pressure + traction).double();
    let weight = floor.weight(&state).double();
    [weight * y, weight, y]
}

/// The step, where the mean gap is held.
#[derive(Clone, Copy)]
pub(super) struct Advance<T, F> {
    floor: F,
    step: Step<T>,
}

impl<T: Real, F: Floor<T>> PointKernel<T, 1, 3, 3> for Advance<T, F> {
    #[inline(always)]
    fn of(params: &Params, scalars: &Scalars) -> Self {
        Advance {
            floor: F::of(params),
            step: Step::of(scalars),
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 1, 3>) -> Made<T, 3, 3> {
        let ([direction], [gap, pressure, _]) = (point.reads, point.writes);
        let way = [direction, point.line];
        let [gap, pressure, before] =
            self.step
                .take(&self.floor, law, [gap, pressure], way, point.on_surface);
        Made {
            writes: [gap, pressure, before],
            line: point.line,
            terms: balance_terms(&self.floor, law, [gap, pressure], point.on_surface),
        }
    }
}

/// The same from K s0 and with the pressure of the heights, see [`held`](super::held).
impl<T: Real, F: Floor<T>> PointKernel<T, 2, 3, 3> for Advance<T, F> {
    #[inline(always)]
    fn of(params: &Params, scalars: &Scalars) -> Self {
        <Self as PointKernel<T, 1, 3, 3>>::of(params, scalars)
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 2, 3>) -> Made<T, 3, 3> {
        let ([direction, rigid], [_, pressure, _]) = (point.reads, point.writes);
        let answer = point.line + self.step.restore * (point.line + (pressure - rigid));
        self.at(
            law,
            Point {
                reads: [direction],
                writes: point.writes,
                line: answer,
                on_surface: point.on_surface,
            },
        )
    }
}

point_kernel!(
    /// Takes K s0 and steps, where the mean gap is held; sums as `wall_balance`. Reads direction, the pressure
    /// of the heights; updates gap, pressure; writes the old yF.
    WALL_ADVANCE, wall_advance, Store, Advance over Rigid by each_point, reads 2, writes 3, fresh 1,
    sums [Add, Add, Min], gate Running
);

/// What gives the mean pressure under a held mean gap.
#[derive(Clone, Copy)]
pub(super) struct Weighing<T, F> {
    floor: F,
    number: PhantomData<T>,
}

impl<T: Real, F: Floor<T>> PointKernel<T, 2, 0, 3> for Weighing<T, F> {
    #[inline(always)]
    fn of(params: &Params, _: &Scalars) -> Self {
        Weighing {
            floor: F::of(params),
            number: PhantomData,
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 2, 0>) -> Made<T, 0, 3> {
        Made {
            writes: [],
            line: point.line,
            terms: balance_terms(&self.floor, law, point.reads, point.on_surface),
        }
    }
}

point_kernel!(
    /// The sums that give the mean pressure under a held mean gap. Reads gap, pressure.
    WALL_BALANCE, wall_balance, Sweep, Weighing over Rigid by each_point, reads 2, writes 0,
    sums [Add, Add, Min], gate Running
);
