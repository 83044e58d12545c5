//! Scalar kernels of a prescribed mean gap: trials brought back to it, and the mean pressure that it takes.
//!
//! The trial step is s = s0 + c (g + s0), with s0 the trial cut at the constraint and c such that the mean of
//! s is zero; c is known only when s0 is. Over a unilateral constraint that costs no pass of its own: every
//! reduction over s follows from those over s0 and g, since s = (1 + c) s0 + c g and K g = p - K h with K h the
//! pressure of the heights, which a solve has once. So one pass turns the direction, loads s0 and takes these
//! sums, and the step adds c K (g + s0) to K s0. Where an outer state is corrected, g is its open gap, and in
//! place of K h stands what the pressure of the correction, which starts at the outer residual, differs by from K g: that
//! residual less the pressure that the outer gap makes.
//!
//! A mean gap is prescribed on periodic grids alone, which have no pad.

use super::scalar::{VANISHES, quotient, scalar_kernel};
use crate::kernel::{Params, Scalars};

fn restore_mean_gap(params: &Params, scalars: &mut Scalars) {
    if scalars.waits() {
        return;
    }
    if !params.law.has_wall() {
        restore_by_compliance(scalars);
    } else if params.hardness.is_finite() {
        restore_both_sides(scalars);
    } else {
        restore_by_linearity(params, scalars);
    }
}
scalar_kernel!(
    /// Step 4, the end of `plain::trial`: the share of each trial gap that brings the mean back to the
    /// prescribed one.
    RESTORE_MEAN_GAP, restore_mean_gap
);

/// The multiple of the local compliance that keeps the mean of a smooth law's step zero.
fn restore_by_compliance(scalars: &mut Scalars) {
    scalars.mean_gap_correction = quotient(scalars.sums.step_sum, scalars.sums.compliance_sum);
}

/// Of a solid with a hardness: gaps below zero are scaled the other way.
fn restore_both_sides(scalars: &mut Scalars) {
    let sums = scalars.sums;
    let size = sums.gap_sum + sums.step_sum + 2.0 * sums.depth_sum;
    scalars.mean_gap_correction = 0.0;
    if size > 0.0 {
        scalars.mean_gap_correction = -sums.step_sum / size;
    }
}

/// Over a unilateral constraint: puts in place of the sums over s0 those over s that `accept_trial` reads.
fn restore_by_linearity(params: &Params, scalars: &mut Scalars) {
    let sums = scalars.sums;
    let open = sums.gap_sum;
    let trial = open + sums.step_sum;
    let mut correction = 0.0;
    if trial > 0.0 {
        correction = -sums.step_sum / trial;
    }
    let whole = 1.0 + correction;
    scalars.mean_gap_correction = correction;
    scalars.sums.slope = whole * sums.slope + correction * sums.gap_slope;
    // s touches where -s/g is largest, and with s0/g linear so is s/g. An open point that was cut, whose -s0/g
    // is 1, touches at the step 1 exactly.
    let mut most = 1.0;
    if sums.closing < 1.0 {
        most = whole * sums.closing - correction;
    }
    scalars.sums.first_touch = f64::INFINITY;
    if open > 0.0 && most > 0.0 {
        scalars.sums.first_touch = 1.0 / most;
    }
    if open > 0.0 && trial <= 0.0 {
        // Nothing is left of the gap that could be scaled back to the mean: the trial is lost.
        scalars.sums.slope = 0.0;
    }
    if open > 0.0 && most <= VANISHES * params.epsilon * (sums.closing.abs() + correction.abs()) {
        // Since the sum of s is zero, -s/g is above zero somewhere unless s vanishes. Here it does but for
        // its rounding, which has no mean of zero and would be taken any distance. The direction is lost.
        scalars.sums.slope = 0.0;
        scalars.sums.first_touch = f64::INFINITY;
        scalars.sums.largest_step = 0.0;
        scalars.sums.least_step = 0.0;
        return;
    }
    // The largest and the least s differ from these by c g. They are asked twice. Whether the step vanishes:
    // s0 = 0 has c = 0; a step that c undoes, s0 as g, has no slope and is a lost trial. And for the size of
    // the roundings that leave a point open that has closed: |c| is at most the largest s0 over the mean
    // gap, so these are too small at most by the largest gap over the mean one.
    scalars.sums.largest_step = whole * sums.largest_step;
    scalars.sums.least_step = whole * sums.least_step;
}

fn curvature_by_linearity(params: &Params, scalars: &mut Scalars) {
    if scalars.waits() || !scalars.accepted {
        return;
    }
    let correction = scalars.mean_gap_correction;
    let whole = 1.0 + correction;
    let step = whole * whole * scalars.curvature;
    let mixed = 2.0 * whole * correction * scalars.sums.step_gap_curvature;
    let own = correction * correction * scalars.sums.gap_curvature;
    scalars.curvature = step + mixed + own;
    // K g is a difference of pressures that are as large as K h: where gaps are below the rounding of the
    // heights the sums cancel completely. Clamp the curvature, or it is mistaken for a rigid-body step; a
    // small curvature leaves the step to where the trial was cut or a point touches.
    let least = params.epsilon * (step + mixed.abs() + own.abs());
    if scalars.curvature < least {
        scalars.curvature = least;
    }
}
scalar_kernel!(
    /// Step 5: `<s, K s>` from `<s0, K s0>`, which the convolution has handed in.
    CURVATURE_BY_LINEARITY, curvature_by_linearity
);

fn mean_pressure(_: &Params, scalars: &mut Scalars) {
    if scalars.waits() {
        return;
    }
    let sums = scalars.sums;
    if sums.pressure_weight > 0.0 {
        scalars.mean_pressure = -sums.weighted_pressure / sums.pressure_weight;
    } else {
        scalars.mean_pressure = -sums.least_pressure;
    }
}
scalar_kernel!(
    /// `plain::state`: the one that a prescribed mean gap takes, minus the weighted mean of p + sigma.
    MEAN_PRESSURE, mean_pressure
);

fn restore_outer_mean_gap(_: &Params, scalars: &mut Scalars) {
    scalars.mean_gap_correction = 0.0;
    if scalars.sums.restoring_weight > 0.0 {
        scalars.mean_gap_correction = scalars.sums.gap_excess / scalars.sums.restoring_weight;
    }
}
scalar_kernel!(
    /// The share of each point's weight that brings the mean gap of the outer state back; 0 where nothing
    /// has any.
    RESTORE_OUTER_MEAN_GAP, restore_outer_mean_gap
);
