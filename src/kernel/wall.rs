//! Kernels of the laws with a hard wall: the gap is bounded below by zero.
//!
//! Notation in short formulas: g gap, p = K*(g+h), y = p + mean_pressure + sigma(g), F the free
//! points (g > 0 or y < 0), yF = y on F and 0 elsewhere, d direction, s trial step. Points of a pad
//! have no wall and no law: they are always free.

use super::coarse;
use super::floor::{Balance, Floor, Rigid, Violation, trial_step};
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
fn add_residual<T: Real>(
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

/// Keeps the lines in the first written field.
pub(super) fn keep_lines<T: Real>(rows: &mut Rows<T>) {
    let count = rows.len();
    rows.writes[0][..count].copy_from_slice(&rows.lines[..count]);
}

fn wall_free_kept<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    wall_free(rows, params, scalars, sums);
    keep_lines(rows);
}
kernel!(
    /// As `wall_free`, and keeps yF in a field for the coarse level. Reads gap, pressure; writes yF.
    WALL_FREE_KEPT, wall_free_kept, Load, reads 2, writes 1, whole false,
    sums [Add, Add, Min, Add], gate Fresh
);

/// The sums from which the direction's conjugacy is found; slots as `scalar::direct` reads them.
#[inline(always)]
fn add_descent<T: Real>(
    sums: &mut [f64; SUMS],
    z: T,
    y_free: T,
    y_before: T,
    direction: T,
    free: bool,
    held: bool,
) {
    let (z, y, before, d) = (
        z.double(),
        y_free.double(),
        y_before.double(),
        direction.double(),
    );
    let change = y - before;
    sums[2] += d * change;
    if free {
        sums[0] += z * y;
        sums[1] += z * change;
        sums[3] += d * y;
        if held {
            sums[4] += z;
            sums[5] += 1.0;
            sums[6] += y;
            sums[7] += change;
            sums[8] += d;
        }
    }
}

/// The twin of `wall_descent` over a floor.
pub(super) fn descent<T: Real, F: Floor<T>>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let count = rows.len();
    let [gap, pressure, direction, _] = rows.reads;
    let (gap, pressure, direction) = (&gap[..count], &pressure[..count], &direction[..count]);
    let lines = &rows.lines[..count];
    let [z_out, y_before, _] = &mut rows.writes;
    let (z_out, y_before) = (&mut z_out[..count], &mut y_before[..count]);
    let mean = T::of(scalars.mean_pressure);
    let held = params.fixed_gap;
    let floor = F::of(params);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let Balance { y, free } = balance(&floor, &law, gap[i], pressure[i] + mean, on_surface);
        let y_free = if free { y } else { T::zero() };
        let z = if free { lines[i] } else { T::zero() };
        add_descent(sums, z, y_free, y_before[i], direction[i], free, held);
        z_out[i] = z;
        y_before[i] = y_free;
    }));
}

fn wall_descent<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    descent::<T, Rigid>(rows, params, scalars, sums);
}
kernel!(
    /// Stores the preconditioned residual z on free points. Reads gap, pressure, direction;
    /// writes z and replaces the old yF by the new one.
    WALL_DESCENT, wall_descent, Store, reads 3, writes 2, whole false,
    sums [Add, Add, Add, Add, Add, Add, Add, Add, Add], gate Fresh
);

fn wall_descent_two_band<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    coarse::add_interpolated(rows);
    wall_descent(rows, params, scalars, sums);
}
kernel!(
    /// As `wall_descent`, with the long waves added from the coarse level. Whole: the coarse z.
    WALL_DESCENT_TWO_BAND, wall_descent_two_band, Store, reads 3, writes 2, whole true,
    sums [Add, Add, Add, Add, Add, Add, Add, Add, Add], gate Fresh
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
    let [gap, pressure, z, _] = rows.reads;
    let (gap, pressure, z) = (&gap[..count], &pressure[..count], &z[..count]);
    let direction = &mut rows.writes[0][..count];
    let lines = &mut rows.lines[..count];
    let mean = T::of(scalars.mean_pressure);
    let factors = [scalars.descent, scalars.memory, scalars.shift].map(T::of);
    let length = T::of(scalars.trial);
    let floor = F::of(params);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let Balance { y, free } = balance(&floor, &law, gap[i], pressure[i] + mean, on_surface);
        let d = new_direction(z[i], direction[i], factors, free);
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
    /// Turns the direction and loads the trial step s. Reads gap, pressure, z; updates direction.
    WALL_TRIAL, wall_trial, Load, reads 3, writes 1, whole false,
    sums [Add, Min, Max, Min, Max], gate Running
);

fn wall_direct<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let [gap, pressure, z, _] = rows.reads;
    let direction = &mut rows.writes[0];
    let mean = T::of(scalars.mean_pressure);
    let factors = [scalars.descent, scalars.memory, scalars.shift].map(T::of);
    let length = T::of(scalars.trial);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let here = balance(&Rigid, &law, gap[i], pressure[i] + mean, on_surface);
        let d = new_direction(z[i], direction[i], factors, here.free);
        direction[i] = d;
        let open = law.open(gap[i]);
        sums[0] += (length * d).max(-open).double();
        sums[1] += open.double();
    }));
}
kernel!(
    /// Turns the direction and sums the trial step and the gap (fixed mean gap). Reads gap,
    /// pressure, z; updates direction.
    WALL_DIRECT, wall_direct, Sweep, reads 3, writes 1, whole false,
    sums [Add, Add], gate Running
);

fn wall_trial_held<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let [gap, pressure, direction, _] = rows.reads;
    let lines = &mut *rows.lines;
    let mean = T::of(scalars.mean_pressure);
    let length = T::of(scalars.trial);
    let restore = T::of(scalars.restore);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let y = balance(&Rigid, &law, gap[i], pressure[i] + mean, on_surface).y;
        let open = law.open(gap[i]);
        let (step, cut) = step_of(&Rigid, [open, y, length * direction[i], restore], on_surface);
        add_trial(sums, [step, y, open], cut, on_surface);
        lines[i] = step;
    }));
}
kernel!(
    /// Loads the trial step scaled back to the held mean gap. Reads gap, pressure, direction.
    WALL_TRIAL_HELD, wall_trial_held, Load, reads 3, writes 0, whole false,
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

fn wall_advance<T: Real>(
    rows: &mut Rows<T>,
    _params: &Params,
    scalars: &Scalars,
    _sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let count = rows.len();
    let direction = &rows.reads[0][..count];
    let lines = &rows.lines[..count];
    let [gap, pressure, _] = &mut rows.writes;
    let (gap, pressure) = (&mut gap[..count], &mut pressure[..count]);
    let length = T::of(scalars.trial);
    let restore = T::of(scalars.restore);
    let t = T::of(scalars.step);
    let snap = T::of(scalars.snap);
    let base = rows.base[0];
    let mut point = |i: usize, floor: T, on_surface: bool| {
        let open = gap[i] - floor;
        let moved = length * direction[i];
        let step = if on_surface {
            trial_step(open, moved, restore, false)
        } else {
            moved
        };
        let moved = gap[i] + t * step;
        let left = open + t * step;
        // By what is left of the gap, which a cut makes exactly zero.
        let closed = on_surface && (left <= T::zero() || (step < T::zero() && left < snap));
        gap[i] = if closed { floor } else { moved };
        pressure[i] += t * lines[i];
    };
    if base.is_empty() {
        layout.points(|i, on_surface| point(i, T::zero(), on_surface));
    } else {
        layout.points(|i, on_surface| point(i, -base[i], on_surface));
    }
}
kernel!(
    /// Takes K s and steps: g += t s, p += t K s. Reads direction; updates gap, pressure.
    WALL_ADVANCE, wall_advance, Store, reads 1, writes 2, whole false,
    sums [], gate Accepted
);

fn wall_balance<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    _scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let [gap, pressure, ..] = rows.reads;
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let y = balance(&Rigid, &law, gap[i], pressure[i], on_surface).y.double();
        let open = law.open(gap[i]).double();
        sums[0] += open * y;
        sums[1] += open;
        if y < sums[2] {
            sums[2] = y;
        }
    }));
}
kernel!(
    /// The sums that give the mean pressure under a held mean gap. Reads gap, pressure.
    WALL_BALANCE, wall_balance, Sweep, reads 2, writes 0, whole false,
    sums [Add, Add, Min], gate Running
);
