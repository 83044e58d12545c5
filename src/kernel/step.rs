//! Kernels that take the step along a direction, and with it the balance or the residual that follows.
//!
//! They are those of a wall and, by their floor, of a solid that flows. Notation as in
//! [`wall`](super::wall).

use super::floor::{Floor, Rigid};
use super::wall::{add_residual, balance, keep_lines, step_of};
use crate::kernel::{Params, Rows, SUMS, Scalars, kernel};
use crate::law::{Cohesion, LawField};
use crate::real::Real;
use crate::with_law_field;

/// The step of one point, and what stays of it: gap and pressure after it, y on free points before it.
#[inline(always)]
fn step_from<T: Real>(
    floor: &impl Floor<T>,
    law: &impl Cohesion<T>,
    [gap, pressure]: [T; 2],
    [direction, answer]: [T; 2],
    step: &Step<T>,
    on_surface: bool,
) -> [T; 3] {
    let before = balance(floor, law, gap, pressure + step.mean, on_surface);
    let y_before = if before.free { before.y } else { T::zero() };
    if !step.taken {
        return [gap, pressure, y_before];
    }
    let here = [
        law.open(gap),
        before.y,
        step.trial * direction,
        step.restore,
    ];
    let (way, _) = step_of(floor, here, on_surface);
    let moved = if on_surface {
        floor.land(law, gap, before.y, [way, step.length, step.snap])
    } else {
        gap + step.length * way
    };
    [moved, pressure + step.length * answer, y_before]
}

/// What a step is made of, from the scalars.
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
}

/// The twin of `wall_turn` over a floor.
pub(super) fn turn<T: Real, F: Floor<T>>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let count = rows.len();
    let direction = &rows.reads[0][..count];
    let lines = &mut rows.lines[..count];
    let [gap, pressure, y_before, _] = &mut rows.writes;
    let (gap, pressure) = (&mut gap[..count], &mut pressure[..count]);
    let y_before = &mut y_before[..count];
    let step = Step::of(scalars);
    let stiffness_max = T::of(params.stiffness_max);
    let floor = F::of(params);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let here = [gap[i], pressure[i]];
        let way = [direction[i], lines[i]];
        let [g, p, before] = step_from(&floor, &law, here, way, &step, on_surface);
        [gap[i], pressure[i], y_before[i]] = [g, p, before];
        let elastic = p + step.mean;
        add_residual(sums, &floor, &law, [g, elastic, stiffness_max], on_surface);
        let here = balance(&floor, &law, g, elastic, on_surface);
        let y = if here.free { here.y } else { T::zero() };
        let d = direction[i].double();
        sums[4] += d * (y.double() - before.double());
        sums[5] += d * y.double();
        lines[i] = y;
    }));
}

fn wall_turn<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    turn::<T, Rigid>(rows, params, scalars, sums);
}
kernel!(
    /// Takes K s and steps: g += t s, p += t K s; then loads the new yF, as `wall_free` does, with the
    /// sums of the step's direction. Reads direction; updates gap, pressure; writes the old yF.
    WALL_TURN, wall_turn, Turn, reads 1, writes 3, fresh 1, whole false,
    sums [Add, Add, Min, Add, Add, Add], gate Running
);

fn wall_turn_kept<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    wall_turn(rows, params, scalars, sums);
    keep_lines(rows, 3);
}
kernel!(
    /// As `wall_turn`, and keeps the new yF in a field for the coarse level. Writes it after the others.
    WALL_TURN_KEPT, wall_turn_kept, Turn, reads 1, writes 4, fresh 2, whole false,
    sums [Add, Add, Min, Add, Add, Add], gate Running
);

/// The terms of the mean pressure that a held gap asks for.
#[inline(always)]
fn add_balance<T: Real>(
    sums: &mut [f64; SUMS],
    floor: &impl Floor<T>,
    law: &impl Cohesion<T>,
    [gap, pressure]: [T; 2],
    on_surface: bool,
) {
    let traction = if on_surface {
        floor.traction(law, gap)
    } else {
        law.beyond()
    };
    let y = (pressure + traction).double();
    let weight = floor.weight(law, gap).double();
    sums[0] += weight * y;
    sums[1] += weight;
    if y < sums[2] {
        sums[2] = y;
    }
}

/// The twin of `yield_advance` over a floor, and with a second field to read of `wall_advance`: there the
/// lines are K s0, see [`held`](super::held).
pub(super) fn advance<T: Real, F: Floor<T>, const LINEAR: bool>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let count = rows.len();
    let direction = &rows.reads[0][..count];
    let rigid = if LINEAR { &rows.reads[1][..count] } else { &[] };
    let lines = &rows.lines[..count];
    let [gap, pressure, y_before, _] = &mut rows.writes;
    let (gap, pressure) = (&mut gap[..count], &mut pressure[..count]);
    let y_before = &mut y_before[..count];
    let step = Step::of(scalars);
    let floor = F::of(params);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let here = [gap[i], pressure[i]];
        let answer = if LINEAR {
            lines[i] + step.restore * (lines[i] + (pressure[i] - rigid[i]))
        } else {
            lines[i]
        };
        let way = [direction[i], answer];
        let [g, p, before] = step_from(&floor, &law, here, way, &step, on_surface);
        [gap[i], pressure[i], y_before[i]] = [g, p, before];
        add_balance(sums, &floor, &law, [g, p], on_surface);
    }));
}

fn wall_advance<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    advance::<T, Rigid, true>(rows, params, scalars, sums);
}
kernel!(
    /// Takes K s0 and steps, where the mean gap is held; sums as `wall_balance`. Reads direction, the pressure
    /// of the heights; updates gap, pressure; writes the old yF.
    WALL_ADVANCE, wall_advance, Store, reads 2, writes 3, fresh 1, whole false,
    sums [Add, Add, Min], gate Running
);

/// The twin of `wall_balance` over a floor.
pub(super) fn balance_sums<T: Real, F: Floor<T>>(
    rows: &mut Rows<T>,
    params: &Params,
    _scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let [gap, pressure, ..] = rows.reads;
    let floor = F::of(params);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        add_balance(sums, &floor, &law, [gap[i], pressure[i]], on_surface);
    }));
}

fn wall_balance<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    balance_sums::<T, Rigid>(rows, params, scalars, sums);
}
kernel!(
    /// The sums that give the mean pressure under a held mean gap. Reads gap, pressure.
    WALL_BALANCE, wall_balance, Sweep, reads 2, writes 0, whole false,
    sums [Add, Add, Min], gate Running
);
