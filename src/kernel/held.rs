//! The trial step of a wall under a held mean gap, without a pass of its own that scales it back.
//!
//! The trial step is s = s0 + c (g + s0), with s0 = max(-g, a d) and c such that its mean is zero; c is
//! known only when s0 is. All that s is asked for follows from what s0 and g are asked for, since
//! s = (1 + c) s0 + c g, and K g = p - K h with K h the pressure of the heights, which a solve has once.
//! So one pass turns the direction, loads s0 and takes these sums, and the step adds c K (g + s0) to K s0.
//! Where a base is corrected, g is its open gap, and in place of K h stands what the pressure of the
//! correction differs by from K g: minus the pressure that the base's own gap makes.
//!
//! A mean gap is held on periodic grids alone, which have no pad.

use super::floor::Rigid;
use super::scalar::scalar_kernel;
use super::wall::{balance, new_direction, step_of};
use crate::kernel::{Params, Rows, SUMS, ScalarKernel, Scalars, kernel};
use crate::law::{Cohesion, LawField};
use crate::real::Real;
use crate::with_law_field;

/// First of the sums that only the held mean asks for.
const OF_MEAN: usize = 5;
/// Those of the curvature: <s0, K g> and <g, K g>.
const OF_CURVATURE: [usize; 2] = [8, 9];

/// The sums over the step s0 of a point, its y, open gap and K g; slots as `restore_wall` and
/// `curve_wall` read them.
#[inline(always)]
fn add_held<T: Real>(sums: &mut [f64; SUMS], [step, y, open, bent]: [T; 4], cut: bool) {
    if open > T::zero() {
        let closing = (-step / open).double();
        if closing > sums[1] {
            sums[1] = closing;
        }
    }
    let [s, y, g, bent] = [step, y, open, bent].map(T::double);
    sums[0] += s * y;
    if s > sums[2] {
        sums[2] = s;
    }
    if s < sums[3] {
        sums[3] = s;
    }
    if cut {
        sums[4] = 1.0;
    }
    sums[OF_MEAN] += s;
    sums[OF_MEAN + 1] += g;
    sums[OF_MEAN + 2] += g * y;
    sums[OF_CURVATURE[0]] += s * bent;
    sums[OF_CURVATURE[1]] += g * bent;
}

fn wall_trial_held<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    sums: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let count = rows.len();
    let [gap, pressure, rigid, _] = rows.reads;
    let (gap, pressure, rigid) = (&gap[..count], &pressure[..count], &rigid[..count]);
    let direction = &mut rows.writes[0][..count];
    let lines = &mut rows.lines[..count];
    let mean = T::of(scalars.mean_pressure);
    let factors = [scalars.descent, scalars.memory, scalars.shift].map(T::of);
    let length = T::of(scalars.trial);
    with_law_field!(params.law, rows.factor, rows.base, T, law => layout.points(|i, on_surface| {
        let law = LawField::<T>::at(&law, i);
        let here = balance(&Rigid, &law, gap[i], pressure[i] + mean, on_surface);
        let d = new_direction(lines[i], direction[i], factors, here.free);
        direction[i] = d;
        let open = law.open(gap[i]);
        let (step, cut) = step_of(&Rigid, [open, here.y, length * d, T::zero()], on_surface);
        add_held(sums, [step, here.y, open, pressure[i] - rigid[i]], cut);
        lines[i] = step;
    }));
}
kernel!(
    /// Turns the direction by the kept z and loads the trial step s0 as it is before the held mean gap is
    /// restored. Reads gap, pressure, the pressure of the heights; updates direction.
    WALL_TRIAL_HELD, wall_trial_held, Resume, reads 3, writes 1, whole false,
    sums [Add, Max, Max, Min, Max, Add, Add, Add, Add, Add], gate Running
);

fn restore_wall(_: &Params, scalars: &mut Scalars) {
    if scalars.waits() {
        return;
    }
    let [slope, closing, up, down, _, step, open, open_slope, ..] = scalars.sums;
    let trial = open + step;
    let restore = if trial > 0.0 { -step / trial } else { 0.0 };
    let whole = 1.0 + restore;
    scalars.restore = restore;
    scalars.sums[0] = whole * slope + restore * open_slope;
    // s touches where -s/g is largest, and with s0/g linear so is s/g. A point that was cut, whose -s0/g
    // is 1, touches at the step 1 exactly.
    let most = if closing < 1.0 {
        whole * closing - restore
    } else {
        1.0
    };
    let touches = open > 0.0 && most > 0.0;
    scalars.sums[1] = if touches { 1.0 / most } else { f64::INFINITY };
    // The largest and the least s differ from these by c g. They are asked twice. Whether the step vanishes:
    // s0 = 0 has c = 0; a step that c undoes, s0 as g, has no slope and is a lost trial. And for the size of
    // the roundings that leave a point open that has closed: |c| is at most the largest s0 over the mean
    // gap, so these are too small at most by the largest gap over the mean one.
    scalars.sums[2] = whole * up;
    scalars.sums[3] = whole * down;
}
scalar_kernel!(
    /// The share of a trial gap that brings it back to the held mean, and in place of the sums over s0 those
    /// over s that `accept` reads.
    RESTORE_WALL, restore_wall
);

fn curve_wall(_: &Params, scalars: &mut Scalars) {
    if scalars.waits() || !scalars.accepted {
        return;
    }
    let restore = scalars.restore;
    let whole = 1.0 + restore;
    let [mixed, own] = OF_CURVATURE.map(|slot| scalars.sums[slot]);
    scalars.curvature =
        whole * whole * scalars.curvature + restore * (2.0 * whole * mixed + restore * own);
}
scalar_kernel!(
    /// <s, K s> from <s0, K s0>, which the convolution has handed in.
    CURVE_WALL, curve_wall
);
