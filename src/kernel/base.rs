//! What is done to the base of corrections: its residual y, the correction added to it, and the mean
//! gap held. All of it runs in double precision, beside iterations in single.
//!
//! The base is brought back to a held mean gap after each correction: open points in proportion to
//! their gap at a wall, all points in proportion to their compliance at a steep core.

use super::core::Core;
use super::scalar::scalar_kernel;
use crate::kernel::{Params, Rows, SUMS, ScalarKernel, Scalars, kernel};
use crate::law::Cohesion;
use crate::real::Real;
use crate::with_law;

fn base_total<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    _: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let [gap, pressure, ..] = rows.reads;
    let residual = &mut *rows.writes[0];
    let mean = T::of(scalars.mean_pressure);
    let factor = rows.factor;
    with_law!(params.law, T, law => layout.points(|i, on_surface| {
        let elastic = pressure[i] + mean;
        let factor = factor.get(i).copied().unwrap_or(T::one());
        residual[i] = match on_surface {
            true => elastic + factor * law.traction(gap[i]),
            false => elastic,
        };
    }));
}
kernel!(
    /// y = p + mean_pressure + sigma(g), without a law on the pad. Reads gap, pressure; writes y.
    BASE_TOTAL, base_total, Sweep, reads 2, writes 1, fresh 1, whole false, sums [], gate Always
);

fn base_rigid<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let count = rows.len();
    let (heights_pressure, pressure) = (&rows.reads[0][..count], &rows.reads[1][..count]);
    for (i, left) in rows.writes[0][..count].iter_mut().enumerate() {
        *left = heights_pressure[i] - pressure[i];
    }
}
kernel!(
    /// Minus the pressure that the base's gap makes, K h - p. Reads the pressure of the heights, pressure;
    /// writes what takes its place in corrections.
    BASE_RIGID, base_rigid, Sweep, reads 2, writes 1, fresh 1, whole false, sums [], gate Always
);

fn base_add_wall<T: Real>(
    rows: &mut Rows<T>,
    _: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let correction = rows.reads[0];
    let gap = &mut *rows.writes[0];
    layout.points(|i, on_surface| {
        let mut moved = gap[i] + correction[i];
        // A correction closes the points where it undoes the base as single precision has it.
        let undone = -T::of(f64::from(gap[i].double() as f32));
        if on_surface && (correction[i] <= undone || moved < T::zero()) {
            moved = T::zero();
        }
        gap[i] = moved;
        let moved = moved.double();
        sums[0] += moved - scalars.offset;
        sums[1] += moved;
    });
}
kernel!(
    /// Adds a correction found in single precision, over a wall; sums by how much the gap is above the
    /// one that is held, and the gap. Reads the correction; updates gap.
    BASE_ADD_WALL, base_add_wall, Sweep, reads 1, writes 1, whole false, sums [Add, Add], gate Always
);

fn base_add_core<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T, false>::new(params);
    let factor = rows.factor;
    let correction = rows.reads[0];
    let gap = &mut *rows.writes[0];
    layout.points(|i, on_surface| {
        gap[i] += correction[i];
        sums[0] += gap[i].double() - scalars.offset;
        let core = core.at(factor, [&[]; 2], i);
        sums[1] += core.share(gap[i], on_surface).double();
    });
}
kernel!(
    /// The same over a steep core; its second sum is that of the local compliance. Reads the correction;
    /// updates gap.
    BASE_ADD_CORE, base_add_core, Sweep, reads 1, writes 1, whole false, sums [Add, Add], gate Always
);

fn base_hold_wall<T: Real>(rows: &mut Rows<T>, _: &Params, scalars: &Scalars, _: &mut [f64; SUMS]) {
    let count = rows.len();
    let restore = T::of(scalars.restore);
    for gap in &mut rows.writes[0][..count] {
        *gap -= restore * *gap;
    }
}
kernel!(
    /// Brings the mean gap back to the one that is held, over a wall. Updates gap.
    BASE_HOLD_WALL, base_hold_wall, Sweep, reads 0, writes 1, whole false, sums [], gate Always
);

fn base_hold_core<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    _: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let core = Core::<T, false>::new(params);
    let factor = rows.factor;
    let gap = &mut *rows.writes[0];
    let restore = T::of(scalars.restore);
    layout.points(|i, on_surface| {
        let core = core.at(factor, [&[]; 2], i);
        gap[i] -= restore * core.share(gap[i], on_surface);
    });
}
kernel!(
    /// The same over a steep core. Updates gap.
    BASE_HOLD_CORE, base_hold_core, Sweep, reads 0, writes 1, whole false, sums [], gate Always
);

fn restore_base(_: &Params, scalars: &mut Scalars) {
    let [excess, weight, ..] = scalars.sums;
    scalars.restore = if weight > 0.0 { excess / weight } else { 0.0 };
}
scalar_kernel!(
    /// The share of each point's weight that brings the mean gap back; 0 where nothing has any.
    RESTORE_BASE, restore_base
);
