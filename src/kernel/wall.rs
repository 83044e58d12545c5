//! Kernels of the laws with a hard wall: the gap is bounded below by zero.
//!
//! Notation in short formulas: g gap, p = K*(g+h), y = p + mean_pressure + sigma(g), F the free
//! points (g > 0 or y < 0), yF = y on F and 0 elsewhere, d direction, s trial step. Points of a pad
//! have no wall and no law: they are always free.

use super::coarse;
use crate::kernel::{Params, Rows, SUMS, Scalars, kernel};
use crate::law::{Cohesion, LawField};
use crate::real::Real;
use crate::with_law_field;

/// y on free points, 0 elsewhere.
#[inline(always)]
fn free_part<T: Real>(open: T, y: T, on_surface: bool) -> T {
    if is_free(open, y, on_surface) {
        y
    } else {
        T::zero()
    }
}

#[inline(always)]
fn is_free<T: Real>(open: T, y: T, on_surface: bool) -> bool {
    !on_surface || open > T::zero() || y < T::zero()
}

/// y = p + mean_pressure + sigma(g); the pad has no law.
#[inline(always)]
fn total<T: Real>(law: &impl Cohesion<T>, gap: T, pressure: T, mean: T, on_surface: bool) -> T {
    pressure + mean + attraction(law, gap, on_surface)
}

/// sigma(g), or what stands in its place on the pad.
#[inline(always)]
fn attraction<T: Real>(law: &impl Cohesion<T>, gap: T, on_surface: bool) -> T {
    if on_surface {
        law.traction(gap)
    } else {
        law.beyond()
    }
}

/// s = s0 + restore (g + s0) with s0 = max(-g, a d), without a wall on the pad. `restore` is small
/// and kept as itself, not as a factor near one, which would cost it its digits.
#[inline(always)]
fn trial_step<T: Real>(open: T, moved: T, restore: T, on_surface: bool) -> T {
    if !on_surface {
        return moved;
    }
    let step = moved.max(-open);
    step + restore * (open + step)
}

/// The terms of the stopping measure at one point.
#[inline(always)]
fn add_residual<T: Real>(
    sums: &mut [f64; SUMS],
    law: &impl Cohesion<T>,
    gap: T,
    y: T,
    traction: T,
    stiffness_max: T,
    on_surface: bool,
) {
    if on_surface {
        let open = law.open(gap);
        let violation = y.min(open * stiffness_max).double();
        sums[0] += violation * violation;
        let reaction = if open > T::zero() {
            T::zero()
        } else {
            law.weighed(y.max(T::zero()))
        };
        let (reaction, traction) = (reaction.double(), law.weighed(traction).double());
        sums[1] += reaction * reaction + traction * traction;
        let open = open.double();
        if open < sums[2] {
            sums[2] = open;
        }
        let gap = gap.double();
        sums[3] += gap * gap;
    } else {
        let y = y.double();
        sums[0] += y * y;
    }
}

fn wall_residual<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let [gap, pressure, ..] = rows.reads;
    let mean = T::of(scalars.mean_pressure);
    let stiffness_max = T::of(params.stiffness_max);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let y = total(&law, gap[i], pressure[i], mean, on_surface);
        let traction = attraction(&law, gap[i], on_surface);
        add_residual(sums, &law, gap[i], y, traction, stiffness_max, on_surface);
    }));
}
kernel!(
    /// The stopping measure of the present state. Reads gap, pressure.
    WALL_RESIDUAL, wall_residual, Sweep, reads 2, writes 0, whole false,
    sums [Add, Add, Min, Add], gate Always
);

fn wall_free<T: Real>(
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
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let traction = attraction(&law, gap[i], on_surface);
        let y = pressure[i] + mean + traction;
        add_residual(sums, &law, gap[i], y, traction, stiffness_max, on_surface);
        lines[i] = free_part(law.open(gap[i]), y, on_surface);
    }));
}
kernel!(
    /// Loads yF and sums the stopping measure on the way. Reads gap, pressure.
    WALL_FREE, wall_free, Load, reads 2, writes 0, whole false,
    sums [Add, Add, Min, Add], gate Fresh
);

fn wall_free_kept<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    wall_free(rows, params, scalars, sums);
    let count = rows.len();
    rows.writes[0][..count].copy_from_slice(&rows.lines[..count]);
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

fn wall_descent<T: Real>(
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
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let y = total(&law, gap[i], pressure[i], mean, on_surface);
        let free = is_free(law.open(gap[i]), y, on_surface);
        let y_free = if free { y } else { T::zero() };
        let z = if free { lines[i] } else { T::zero() };
        add_descent(sums, z, y_free, y_before[i], direction[i], free, held);
        z_out[i] = z;
        y_before[i] = y_free;
    }));
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
fn new_direction<T: Real>(z: T, direction: T, factors: [T; 3], free: bool) -> T {
    if free {
        factors[0] * z + factors[1] * direction + factors[2]
    } else {
        T::zero()
    }
}

/// The sums over a trial step; slots as `scalar::accept` reads them.
#[inline(always)]
fn add_trial<T: Real>(sums: &mut [f64; SUMS], step: T, y: T, gap: T, cut: bool, on_surface: bool) {
    let s = step.double();
    sums[0] += s * y.double();
    if s < 0.0 && on_surface {
        let ratio = gap.double() / -s;
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

fn wall_trial<T: Real>(
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
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let y = total(&law, gap[i], pressure[i], mean, on_surface);
        let open = law.open(gap[i]);
        let d = new_direction(z[i], direction[i], factors, is_free(open, y, on_surface));
        direction[i] = d;
        let moved = length * d;
        let step = trial_step(open, moved, T::zero(), on_surface);
        let cut = on_surface && open + moved < T::zero();
        add_trial(sums, step, y, open, cut, on_surface);
        lines[i] = step;
    }));
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
        let y = total(&law, gap[i], pressure[i], mean, on_surface);
        let open = law.open(gap[i]);
        let d = new_direction(z[i], direction[i], factors, is_free(open, y, on_surface));
        direction[i] = d;
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
        let y = total(&law, gap[i], pressure[i], mean, on_surface);
        let moved = length * direction[i];
        let open = law.open(gap[i]);
        let step = trial_step(open, moved, restore, on_surface);
        let cut = on_surface && open + moved < T::zero();
        add_trial(sums, step, y, open, cut, on_surface);
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
            let step = trial_step(law.open(gap[i]), length * direction[i], restore, true);
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
        let step = trial_step(open, length * direction[i], restore, on_surface);
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
        let y = total(&law, gap[i], pressure[i], T::zero(), on_surface).double();
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
