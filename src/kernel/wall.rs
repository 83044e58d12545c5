//! Kernels of the laws with a hard wall: the gap is bounded below by zero.
//!
//! Notation in short formulas: g gap, p = K*(g+h), y = p + mean_pressure + sigma(g), F the free
//! points (g > 0 or y < 0), yF = y on F and 0 elsewhere, d direction, s trial step. Points of a pad
//! have no wall and no law: they are always free.

use super::floor::{Balance, Floor, Rigid, Violation, trial_step};
pub use super::held::WALL_TRIAL_HELD;
pub use super::step::{WALL_ADVANCE, WALL_BALANCE, WALL_TURN, WALL_TURN_KEPT};
use crate::kernel::{Params, Rows, SUMS, Scalars, kernel};
use crate::law::{Cohesion, LawField};
use crate::real::Real;
use crate::with_law_field;

/// The balance of a point; those of the pad are free and have no law.
#[inline(always)]
pub(super) fn balance<T: Real>(
    floor: &impl Floor<T>,
    law: &impl Cohesion<T>,
    gap: T,
    elastic: T,
    on_surface: bool,
) -> Balance<T> {
    if on_surface {
        floor.balance(law, gap, elastic)
    } else {
        Balance {
            y: elastic + law.beyond(),
            free: true,
        }
    }
}

/// The trial step of a point, of its open gap, y, way and share to restore, and whether it was cut at zero; the pad
/// has no floor.
#[inline(always)]
pub(super) fn step_of<T: Real>(
    floor: &impl Floor<T>,
    [open, y, moved, restore]: [T; 4],
    on_surface: bool,
) -> (T, bool) {
    if !on_surface {
        return (moved, false);
    }
    let down = floor.goes_down(open, y);
    let cut = if down {
        open + moved > T::zero()
    } else {
        open + moved < T::zero()
    };
    (trial_step(open, moved, restore, down), cut)
}

/// The terms of the stopping measure at one point, of its gap, p + mean_pressure and the largest
/// stiffness.
#[inline(always)]
pub(super) fn add_residual<T: Real>(
    sums: &mut [f64; SUMS],
    floor: &impl Floor<T>,
    law: &impl Cohesion<T>,
    [gap, elastic, stiffness_max]: [T; 3],
    on_surface: bool,
) {
    if on_surface {
        let Violation {
            violation,
            reaction,
            traction,
        } = floor.violation(law, gap, elastic, stiffness_max);
        let violation = violation.double();
        sums[0] += violation * violation;
        let (reaction, traction) = (reaction.double(), traction.double());
        sums[1] += reaction * reaction + traction * traction;
        let open = law.open(gap).double();
        if open < sums[2] {
            sums[2] = open;
        }
        let gap = gap.double();
        sums[3] += gap * gap;
    } else {
        let y = (elastic + law.beyond()).double();
        sums[0] += y * y;
    }
}

/// The twin of `wall_residual` over a floor.
pub(super) fn residual<T: Real, F: Floor<T>>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let [gap, pressure, ..] = rows.reads;
    let mean = T::of(scalars.mean_pressure);
    let stiffness_max = T::of(params.stiffness_max);
    let floor = F::of(params);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let here = [gap[i], pressure[i] + mean, stiffness_max];
        add_residual(sums, &floor, &law, here, on_surface);
    }));
}

fn wall_residual<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    residual::<T, Rigid>(rows, params, scalars, sums);
}
kernel!(
    /// The stopping measure of the present state. Reads gap, pressure.
    WALL_RESIDUAL, wall_residual, Sweep, reads 2, writes 0, whole false,
    sums [Add, Add, Min, Add], gate Always
);

/// The twin of `wall_free` over a floor.
pub(super) fn free<T: Real, F: Floor<T>>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let count = rows.len();
    let gap = &rows.reads[0][..count];
    let pressure = &rows.reads[1][..count];
    let lines = &mut rows.lines[..count];
    let mean = T::of(scalars.mean_pressure);
    let stiffness_max = T::of(params.stiffness_max);
    let floor = F::of(params);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let elastic = pressure[i] + mean;
        add_residual(sums, &floor, &law, [gap[i], elastic, stiffness_max], on_surface);
        let here = balance(&floor, &law, gap[i], elastic, on_surface);
        lines[i] = if here.free { here.y } else { T::zero() };
    }));
}

fn wall_free<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    free::<T, Rigid>(rows, params, scalars, sums);
}
kernel!(
    /// Loads yF and sums the stopping measure on the way. Reads gap, pressure.
    WALL_FREE, wall_free, Load, reads 2, writes 0, whole false,
    sums [Add, Add, Min, Add], gate Fresh
);

/// Keeps the lines in a written field.
pub(super) fn keep_lines<T: Real>(rows: &mut Rows<T>, place: usize) {
    let count = rows.len();
    rows.writes[place][..count].copy_from_slice(&rows.lines[..count]);
}

fn wall_free_kept<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    wall_free(rows, params, scalars, sums);
    keep_lines(rows, 0);
}
kernel!(
    /// As `wall_free`, and keeps yF in a field for the coarse level. Reads gap, pressure; writes yF.
    WALL_FREE_KEPT, wall_free_kept, Load, reads 2, writes 1, fresh 1, whole false,
    sums [Add, Add, Min, Add], gate Fresh
);

/// The sums from which the direction's conjugacy is found; slots as `scalar::direct` reads them.
#[inline(always)]
pub(super) fn add_descent<T: Real>(sums: &mut [f64; SUMS], z: T, y_free: T, y_before: T) {
    let (z, y) = (z.double(), y_free.double());
    sums[0] += z * y;
    sums[1] += z * (y - y_before.double());
}

/// Those that the direction enters too, and what takes the means off (fixed mean gap).
#[inline(always)]
pub(super) fn add_descent_held<T: Real>(
    sums: &mut [f64; SUMS],
    [z, y_free, y_before, direction]: [T; 4],
    free: bool,
) {
    add_descent(sums, z, y_free, y_before);
    let (z, y, d) = (z.double(), y_free.double(), direction.double());
    let change = y - y_before.double();
    sums[2] += d * change;
    if free {
        sums[3] += d * y;
        sums[4] += z;
        sums[5] += 1.0;
        sums[6] += y;
        sums[7] += change;
        sums[8] += d;
    }
}

/// The twin of `wall_descent` over a floor, and with a fourth field of `wall_descent_held`.
pub(super) fn descent<T: Real, F: Floor<T>, const HELD: bool>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let count = rows.len();
    let [gap, pressure, y_before, direction] = rows.reads;
    let (gap, pressure, y_before) = (&gap[..count], &pressure[..count], &y_before[..count]);
    let lines = &mut rows.lines[..count];
    let mean = T::of(scalars.mean_pressure);
    let floor = F::of(params);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let Balance { y, free } = balance(&floor, &law, gap[i], pressure[i] + mean, on_surface);
        let [y, z] = if free { [y, lines[i]] } else { [T::zero(); 2] };
        if HELD {
            add_descent_held(sums, [z, y, y_before[i], direction[i]], free);
        } else {
            add_descent(sums, z, y, y_before[i]);
        }
        lines[i] = z;
    }));
}

fn wall_descent<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    descent::<T, Rigid, false>(rows, params, scalars, sums);
}
kernel!(
    /// Keeps the preconditioned residual z on free points. Reads gap, pressure, the old yF.
    WALL_DESCENT, wall_descent, Keep, reads 3, writes 0, whole false,
    sums [Add, Add], gate Ahead
);

fn wall_descent_held<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    descent::<T, Rigid, true>(rows, params, scalars, sums);
}
kernel!(
    /// The same where the mean gap is held. Reads gap, pressure, the old yF, direction.
    WALL_DESCENT_HELD, wall_descent_held, Keep, reads 4, writes 0, whole false,
    sums [Add, Add, Add, Add, Add, Add, Add, Add, Add], gate Ahead
);

/// The new direction at one point: zero where the point is not free.
#[inline(always)]
pub(super) fn new_direction<T: Real>(z: T, direction: T, factors: [T; 3], free: bool) -> T {
    if free {
        factors[0] * z + factors[1] * direction + factors[2]
    } else {
        T::zero()
    }
}

/// The sums over a trial step; slots as `scalar::accept` reads them.
#[inline(always)]
pub(super) fn add_trial<T: Real>(
    sums: &mut [f64; SUMS],
    [step, y, open]: [T; 3],
    cut: bool,
    on_surface: bool,
) {
    let s = step.double();
    sums[0] += s * y.double();
    let closes = (open >= T::zero() && s < 0.0) || (open < T::zero() && s > 0.0);
    if closes && on_surface {
        let ratio = open.double() / -s;
        if ratio < sums[1] {
            sums[1] = ratio;
        }
    }
    if s > sums[2] {
        sums[2] = s;
    }
    if s < sums[3] {
        sums[3] = s;
    }
    if cut {
        sums[4] = 1.0;
    }
}

/// The twin of `wall_trial` over a floor.
pub(super) fn trial<T: Real, F: Floor<T>>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let count = rows.len();
    let [gap, pressure, ..] = rows.reads;
    let (gap, pressure) = (&gap[..count], &pressure[..count]);
    let direction = &mut rows.writes[0][..count];
    let lines = &mut rows.lines[..count];
    let mean = T::of(scalars.mean_pressure);
    let factors = [scalars.descent, scalars.memory, scalars.shift].map(T::of);
    let length = T::of(scalars.trial);
    let floor = F::of(params);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let Balance { y, free } = balance(&floor, &law, gap[i], pressure[i] + mean, on_surface);
        let d = new_direction(lines[i], direction[i], factors, free);
        direction[i] = d;
        let open = law.open(gap[i]);
        let (step, cut) = step_of(&floor, [open, y, length * d, T::zero()], on_surface);
        add_trial(sums, [step, y, open], cut, on_surface);
        lines[i] = step;
    }));
}

fn wall_trial<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    trial::<T, Rigid>(rows, params, scalars, sums);
}
kernel!(
    /// Turns the direction by the kept z and loads the trial step s. Reads gap, pressure; updates
    /// direction.
    WALL_TRIAL, wall_trial, Resume, reads 2, writes 1, whole false,
    sums [Add, Min, Max, Min, Max], gate Running
);

fn wall_search<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let [gap, direction, ..] = rows.reads;
    let length = T::of(scalars.trial);
    let restore = T::of(scalars.restore);
    let t = T::of(scalars.step);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        if on_surface {
            let step = trial_step(law.open(gap[i]), length * direction[i], restore, false);
            let change = law.change(gap[i], t * step);
            sums[0] += change.double() * step.double();
        }
    }));
}
kernel!(
    /// Sums `<sigma(g + t s) - sigma(g), s>`. Reads gap, direction.
    WALL_SEARCH, wall_search, Sweep, reads 2, writes 0, whole false,
    sums [Add], gate Searching
);
