//! Kernels of the laws with a hard wall: the gap is bounded below by zero.
//!
//! Notation in short formulas: g gap, p = K*(g+h), y = p + mean_pressure + sigma(g), F the free
//! points (g > 0 or y < 0), yF = y on F and 0 elsewhere, d direction, s trial step. Points of a pad
//! have no wall and no law: they are always free.

use std::marker::PhantomData;

use super::floor::{Floor, Rigid, State, trial_step};
pub use super::held::WALL_TRIAL_HELD;
use super::points::{Made, Point, PointKernel};
pub use super::step::{WALL_ADVANCE, WALL_BALANCE, WALL_TURN, WALL_TURN_KEPT};
use crate::kernel::{Params, Scalars, point_kernel};
use crate::law::Cohesion;
use crate::real::Real;

/// A point as the kernels see it: what its floor sees, and its balance.
#[derive(Clone, Copy)]
pub(super) struct Here<T> {
    /// What a floor would see; on a pad the pull is what stands in the traction's place there.
    pub state: State<T>,
    /// y, to the side to which the point may move.
    pub y: T,
    /// Whether it may move.
    pub free: bool,
}

impl<T: Real> Here<T> {
    /// A point of its gap and p + mean_pressure, at which the law is looked at once. Those of the pad are
    /// free and have no law.
    #[inline(always)]
    pub fn at(
        floor: &impl Floor<T>,
        law: &impl Cohesion<T>,
        gap: T,
        elastic: T,
        on_surface: bool,
    ) -> Self {
        if on_surface {
            let state = floor.state(law, gap, elastic);
            let balance = floor.balance(&state);
            Here {
                state,
                y: balance.y,
                free: balance.free,
            }
        } else {
            Here {
                state: State {
                    gap,
                    open: law.open(gap),
                    elastic,
                    pull: law.beyond(),
                },
                y: elastic + law.beyond(),
                free: true,
            }
        }
    }

    /// y on free points, 0 elsewhere.
    #[inline(always)]
    pub fn y_free(&self) -> T {
        if self.free { self.y } else { T::zero() }
    }
}

/// The trial step of a point, of its way and share to restore, and whether it was cut at zero; the pad has
/// no floor.
#[inline(always)]
pub(super) fn step_of<T: Real>(
    floor: &impl Floor<T>,
    here: &Here<T>,
    [moved, restore]: [T; 2],
    on_surface: bool,
) -> (T, bool) {
    if !on_surface {
        return (moved, false);
    }
    let open = here.state.open;
    let down = floor.goes_down(open, here.y);
    let cut = if down {
        open + moved > T::zero()
    } else {
        open + moved < T::zero()
    };
    (trial_step(open, moved, restore, down), cut)
}

/// The terms of the stopping measure at one point, with the largest stiffness.
#[inline(always)]
pub(super) fn residual_terms<T: Real>(
    floor: &impl Floor<T>,
    law: &impl Cohesion<T>,
    here: &Here<T>,
    stiffness_max: T,
    on_surface: bool,
) -> [f64; 4] {
    if !on_surface {
        let y = here.y.double();
        return [y * y, 0.0, f64::INFINITY, 0.0];
    }
    let found = floor.violation(&here.state, stiffness_max);
    let violation = found.violation.double();
    let reaction = law.weighed(found.reaction).double();
    let traction = law.weighed(found.traction).double();
    let gap = here.state.gap.double();
    [
        violation * violation,
        reaction * reaction + traction * traction,
        here.state.open.double(),
        gap * gap,
    ]
}

/// The stopping measure, and yF on the way.
#[derive(Clone, Copy)]
pub(super) struct Free<T, F> {
    floor: F,
    mean: T,
    stiffness_max: T,
}

impl<T: Real, F: Floor<T>> PointKernel<T, 2, 0, 4> for Free<T, F> {
    #[inline(always)]
    fn of(params: &Params, scalars: &Scalars) -> Self {
        Free {
            floor: F::of(params),
            mean: T::of(scalars.mean_pressure),
            stiffness_max: T::of(params.stiffness_max),
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 2, 0>) -> Made<T, 0, 4> {
        let [gap, pressure] = point.reads;
        let here = Here::at(
            &self.floor,
            law,
            gap,
            pressure + self.mean,
            point.on_surface,
        );
        Made {
            writes: [],
            line: here.y_free(),
            terms: residual_terms(
                &self.floor,
                law,
                &here,
                self.stiffness_max,
                point.on_surface,
            ),
        }
    }
}

point_kernel!(
    /// The stopping measure of the present state. Reads gap, pressure.
    WALL_RESIDUAL, wall_residual, Sweep, Free over Rigid by each_point, reads 2, writes 0,
    sums [Add, Add, Min, Add], gate Always
);
point_kernel!(
    /// Loads yF and sums the stopping measure on the way. Reads gap, pressure.
    WALL_FREE, wall_free, Load, Free over Rigid by each_point, reads 2, writes 0,
    sums [Add, Add, Min, Add], gate Fresh
);

/// The same, which keeps yF in a field.
#[derive(Clone, Copy)]
pub(super) struct FreeKept<T, F>(Free<T, F>);

impl<T: Real, F: Floor<T>> PointKernel<T, 2, 1, 4> for FreeKept<T, F> {
    #[inline(always)]
    fn of(params: &Params, scalars: &Scalars) -> Self {
        FreeKept(Free::of(params, scalars))
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 2, 1>) -> Made<T, 1, 4> {
        let made = self.0.at(
            law,
            Point {
                reads: point.reads,
                writes: [],
                line: point.line,
                on_surface: point.on_surface,
            },
        );
        Made {
            writes: [made.line],
            line: made.line,
            terms: made.terms,
        }
    }
}

point_kernel!(
    /// As `wall_free`, and keeps yF in a field for the coarse level. Reads gap, pressure; writes yF.
    WALL_FREE_KEPT, wall_free_kept, Load, FreeKept over Rigid by each_point, reads 2, writes 1, fresh 1,
    sums [Add, Add, Min, Add], gate Fresh
);

/// The terms from which the direction's conjugacy is found; slots as `scalar::direct` reads them.
#[inline(always)]
pub(super) fn descent_terms<T: Real>(z: T, y_free: T, y_before: T) -> [f64; 2] {
    let (z, y) = (z.double(), y_free.double());
    [z * y, z * (y - y_before.double())]
}

/// Those that the direction enters too, and what takes the means off (fixed mean gap).
#[inline(always)]
pub(super) fn descent_held_terms<T: Real>(
    [z, y_free, y_before, direction]: [T; 4],
    free: bool,
) -> [f64; 9] {
    let [zy, z_change] = descent_terms(z, y_free, y_before);
    let (z, y, d) = (z.double(), y_free.double(), direction.double());
    let change = y - y_before.double();
    let on_free = |term: f64| if free { term } else { 0.0 };
    [
        zy,
        z_change,
        d * change,
        on_free(d * y),
        on_free(z),
        on_free(1.0),
        on_free(y),
        on_free(change),
        on_free(d),
    ]
}

/// The preconditioned residual z on free points.
#[derive(Clone, Copy)]
pub(super) struct Descent<T, F> {
    floor: F,
    mean: T,
}

impl<T: Real, F: Floor<T>> Descent<T, F> {
    #[inline(always)]
    fn at(
        &self,
        law: &impl Cohesion<T>,
        [gap, pressure, line]: [T; 3],
        on_surface: bool,
    ) -> (Here<T>, T) {
        let here = Here::at(&self.floor, law, gap, pressure + self.mean, on_surface);
        (here, if here.free { line } else { T::zero() })
    }
}

impl<T: Real, F: Floor<T>> PointKernel<T, 3, 0, 2> for Descent<T, F> {
    #[inline(always)]
    fn of(params: &Params, scalars: &Scalars) -> Self {
        Descent {
            floor: F::of(params),
            mean: T::of(scalars.mean_pressure),
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 3, 0>) -> Made<T, 0, 2> {
        let [gap, pressure, y_before] = point.reads;
        let (here, z) = self.at(law, [gap, pressure, point.line], point.on_surface);
        Made {
            writes: [],
            line: z,
            terms: descent_terms(z, here.y_free(), y_before),
        }
    }
}

point_kernel!(
    /// Keeps the preconditioned residual z on free points. Reads gap, pressure, the old yF.
    WALL_DESCENT, wall_descent, Keep, Descent over Rigid by each_point, reads 3, writes 0,
    sums [Add, Add], gate Ahead
);

impl<T: Real, F: Floor<T>> PointKernel<T, 4, 0, 9> for Descent<T, F> {
    #[inline(always)]
    fn of(params: &Params, scalars: &Scalars) -> Self {
        <Self as PointKernel<T, 3, 0, 2>>::of(params, scalars)
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 4, 0>) -> Made<T, 0, 9> {
        let [gap, pressure, y_before, direction] = point.reads;
        let (here, z) = self.at(law, [gap, pressure, point.line], point.on_surface);
        Made {
            writes: [],
            line: z,
            terms: descent_held_terms([z, here.y_free(), y_before, direction], here.free),
        }
    }
}

point_kernel!(
    /// The same where the mean gap is held. Reads gap, pressure, the old yF, direction.
    WALL_DESCENT_HELD, wall_descent_held, Keep, Descent over Rigid by each_point, reads 4, writes 0,
    sums [Add, Add, Add, Add, Add, Add, Add, Add, Add], gate Ahead
);

/// The new direction of a point, from the scalars.
#[derive(Clone, Copy)]
pub(super) struct Directing<T> {
    descent: T,
    memory: T,
    shift: T,
}

impl<T: Real> Directing<T> {
    #[inline(always)]
    pub fn of(scalars: &Scalars) -> Self {
        Directing {
            descent: T::of(scalars.descent),
            memory: T::of(scalars.memory),
            shift: T::of(scalars.shift),
        }
    }

    /// Zero where the point is not free.
    #[inline(always)]
    pub fn turn(&self, z: T, direction: T, free: bool) -> T {
        if free {
            self.descent * z + self.memory * direction + self.shift
        } else {
            T::zero()
        }
    }
}

/// The terms of a trial step; slots as `scalar::accept` reads them.
#[inline(always)]
pub(super) fn trial_terms<T: Real>(
    step: T,
    here: &Here<T>,
    cut: bool,
    on_surface: bool,
) -> [f64; 5] {
    let open = here.state.open;
    let s = step.double();
    let closes = ((open >= T::zero()) & (s < 0.0)) | ((open < T::zero()) & (s > 0.0));
    let ratio = open.double() / -s;
    [
        s * here.y.double(),
        if closes & on_surface {
            ratio
        } else {
            f64::INFINITY
        },
        s,
        s,
        if cut { 1.0 } else { 0.0 },
    ]
}

/// The new direction and its trial step.
#[derive(Clone, Copy)]
pub(super) struct Trial<T, F> {
    floor: F,
    mean: T,
    directing: Directing<T>,
    length: T,
}

impl<T: Real, F: Floor<T>> PointKernel<T, 2, 1, 5> for Trial<T, F> {
    #[inline(always)]
    fn of(params: &Params, scalars: &Scalars) -> Self {
        Trial {
            floor: F::of(params),
            mean: T::of(scalars.mean_pressure),
            directing: Directing::of(scalars),
            length: T::of(scalars.trial),
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 2, 1>) -> Made<T, 1, 5> {
        let ([gap, pressure], [direction]) = (point.reads, point.writes);
        let on_surface = point.on_surface;
        let here = Here::at(&self.floor, law, gap, pressure + self.mean, on_surface);
        let d = self.directing.turn(point.line, direction, here.free);
        let way = [self.length * d, T::zero()];
        let (step, cut) = step_of(&self.floor, &here, way, on_surface);
        Made {
            writes: [d],
            line: step,
            terms: trial_terms(step, &here, cut, on_surface),
        }
    }
}

point_kernel!(
    /// Turns the direction by the kept z and loads the trial step s. Reads gap, pressure; updates
    /// direction.
    WALL_TRIAL, wall_trial, Resume, Trial over Rigid by each_point, reads 2, writes 1,
    sums [Add, Min, Max, Min, Max], gate Running
);

/// What the step t does to the traction.
#[derive(Clone, Copy)]
pub(super) struct Search<T, F> {
    floor: PhantomData<F>,
    length: T,
    restore: T,
    t: T,
}

impl<T: Real, F: Floor<T>> PointKernel<T, 2, 0, 1> for Search<T, F> {
    #[inline(always)]
    fn of(_: &Params, scalars: &Scalars) -> Self {
        Search {
            floor: PhantomData,
            length: T::of(scalars.trial),
            restore: T::of(scalars.restore),
            t: T::of(scalars.step),
        }
    }

    #[inline(always)]
    fn at(&self, law: &impl Cohesion<T>, point: Point<T, 2, 0>) -> Made<T, 0, 1> {
        let [gap, direction] = point.reads;
        let step = trial_step(law.open(gap), self.length * direction, self.restore, false);
        let change = law.change(gap, self.t * step).double() * step.double();
        Made {
            writes: [],
            line: point.line,
            terms: [if point.on_surface { change } else { 0.0 }],
        }
    }
}

point_kernel!(
    /// Sums `<sigma(g + t s) - sigma(g), s>`. Reads gap, direction.
    WALL_SEARCH, wall_search, Sweep, Search over Rigid by each_point, reads 2, writes 0,
    sums [Add], gate Searching
);
