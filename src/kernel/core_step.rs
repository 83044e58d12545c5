//! Kernels of the Lennard-Jones law that take the step along a direction, and with it the balance or the
//! residual that follows.

use super::core::{Core, add_residual, with_or_without_base};
use crate::kernel::{Params, Rows, SUMS, Scalars, kernel};
use crate::real::Real;

with_or_without_base!(core_turn, turn);

fn turn<T: Real, const BASE: bool>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T, BASE>::new(params);
    let (factor, base) = (rows.factor, rows.base);
    let [direction, step, ..] = rows.reads;
    let lines = &mut *rows.lines;
    let [gap, pressure, y_before, _] = &mut rows.writes;
    let t: T = taken(scalars);
    let mean = T::of(scalars.mean_pressure);
    layout.points(|i, on_surface| {
        let core = core.at(factor, base, i);
        let y = pressure[i] + mean + core.attraction(gap[i], on_surface);
        let before = core.share(gap[i], on_surface) * y;
        y_before[i] = before;
        gap[i] += t * step[i];
        pressure[i] += t * lines[i];
        let traction = core.attraction(gap[i], on_surface);
        let y = pressure[i] + mean + traction;
        add_residual(sums, &core, gap[i], y, traction, on_surface);
        let y = core.share(gap[i], on_surface) * y;
        let d = direction[i].double();
        sums[4] += d * (y.double() - before.double());
        sums[5] += d * y.double();
        lines[i] = y;
    });
}
kernel!(
    /// Takes K s and steps: g += t s, p += t K s; then loads the new S2 y, as `core_free` does, with the
    /// sums of the step's direction. Reads direction, step; updates gap, pressure; writes the old S2 y.
    CORE_TURN, core_turn, Turn, reads 2, writes 3, fresh 1, whole false,
    sums [Add, Add, Min, Add, Add, Add], gate Running
);

/// The step length; 0 after a lost trial, which leaves all as it is.
fn taken<T: Real>(scalars: &Scalars) -> T {
    match scalars.accepted {
        true => T::of(scalars.step),
        false => T::zero(),
    }
}

/// The terms of the mean pressure that a held gap asks for.
#[inline(always)]
fn add_balance<T: Real, const BASE: bool>(
    sums: &mut [f64; SUMS],
    core: &Core<T, BASE>,
    [gap, pressure]: [T; 2],
    on_surface: bool,
) {
    let share = core.share(gap, on_surface);
    let traction = core.attraction(gap, on_surface);
    sums[0] += (share * (pressure + traction)).double();
    sums[1] += share.double();
}

with_or_without_base!(core_advance, advance);

fn advance<T: Real, const BASE: bool>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T, BASE>::new(params);
    let (factor, base) = (rows.factor, rows.base);
    let step = rows.reads[0];
    let lines = &*rows.lines;
    let [gap, pressure, y_before, _] = &mut rows.writes;
    let t: T = taken(scalars);
    let mean = T::of(scalars.mean_pressure);
    layout.points(|i, on_surface| {
        let core = core.at(factor, base, i);
        let y = pressure[i] + mean + core.attraction(gap[i], on_surface);
        y_before[i] = core.share(gap[i], on_surface) * y;
        gap[i] += t * step[i];
        pressure[i] += t * lines[i];
        add_balance(sums, &core, [gap[i], pressure[i]], on_surface);
    });
}
kernel!(
    /// Takes K s and steps, where the mean gap is held; sums as `core_balance`. Reads step; updates gap,
    /// pressure; writes the old S2 y.
    CORE_ADVANCE, core_advance, Store, reads 1, writes 3, fresh 1, whole false,
    sums [Add, Add], gate Running
);

with_or_without_base!(core_balance, balance);

fn balance<T: Real, const BASE: bool>(
    rows: &mut Rows<T>,
    params: &Params,
    _: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T, BASE>::new(params);
    let (factor, base) = (rows.factor, rows.base);
    let [gap, pressure, ..] = rows.reads;
    layout.points(|i, on_surface| {
        let core = core.at(factor, base, i);
        add_balance(sums, &core, [gap[i], pressure[i]], on_surface);
    });
}
kernel!(
    /// The sums that give the mean pressure under a held mean gap. Reads gap, pressure.
    CORE_BALANCE, core_balance, Sweep, reads 2, writes 0, whole false,
    sums [Add, Add], gate Running
);
