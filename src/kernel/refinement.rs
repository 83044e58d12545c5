//! Iterative refinement: what is done to the outer state, which is kept in double precision beside iterations
//! in single that look for its corrections. Its residual y, the correction added to it, and its mean gap.
//!
//! The outer state is brought back to a prescribed mean gap after each correction: open points in proportion
//! to their gap, with a smooth law all points in proportion to their compliance.

use super::constraint::{GapConstraint, Unilateral, here_at};
use super::points::{Numbers, Point, PointKernel};
use super::smooth::Smooth;
use super::sums::sum_group;
use super::{Kernel, Params, Rows, SUMS, Scalars, point_kernel, rows_kernel};
use crate::law::{Cohesion, imbalance};
use crate::real::Real;
use crate::with_law;

sum_group! {
    /// What brings the mean gap back.
    RestoringSums { gap_excess, restoring_weight }
}

fn outer_residual<T: Real>(
    rows: &mut Rows<T>,
    params: &Params,
    scalars: &Scalars,
    _: &mut [f64; SUMS],
) {
    let layout = rows.layout();
    let [gap, pressure, ..] = rows.reads;
    let residual = &mut *rows.writes[0];
    let mean_pressure = T::from_double(scalars.mean_pressure);
    let factor = rows.factor;
    with_law!(params.law, T, law => layout.points(|i, in_domain| {
        let elastic = pressure[i] + mean_pressure;
        let factor = factor.get(i).copied().unwrap_or(T::one());
        residual[i] = if in_domain {
            imbalance(elastic, factor * law.traction(gap[i]))
        } else {
            elastic
        };
    }));
}

/// y = p + mean_pressure + sigma(g) of the outer state, without a law on the pad: `plain::state`.
pub static OUTER_RESIDUAL: Kernel = rows_kernel!(
    outer_residual, Sweep, gate Always, law true,
    reads [gap, pressure], writes [residual], fresh 1
);

fn outer_pressure<T: Real>(rows: &mut Rows<T>, _: &Params, _: &Scalars, _: &mut [f64; SUMS]) {
    let count = rows.len();
    let (heights_pressure, pressure) = (&rows.reads[0][..count], &rows.reads[1][..count]);
    for (i, residual) in rows.writes[0][..count].iter_mut().enumerate() {
        *residual += heights_pressure[i] - pressure[i];
    }
}

/// The outer residual less the pressure that the outer gap makes, y + K h - p: what takes the place of K h in
/// corrections, whose pressure starts at y.
pub static OUTER_PRESSURE: Kernel = rows_kernel!(
    outer_pressure, Sweep, gate Always, law false,
    reads [heights_pressure, pressure], writes [residual]
);

/// The outer gap with a correction that was found in single precision.
struct AddCorrection;

impl<T: Real, C: GapConstraint<T>> PointKernel<T, C, 1, 1, 2> for AddCorrection {
    #[inline(always)]
    fn at(numbers: &Numbers<T, C>, law: &impl Cohesion<T>, point: &mut Point<T, 1, 1, 2>) {
        let ([correction], [gap], constraint) = (point.reads, point.writes, &numbers.constraint);
        let gap = if point.in_domain {
            constraint.corrected_gap(gap, correction)
        } else {
            gap + correction
        };
        let here = here_at(constraint, law, gap, T::zero(), point.in_domain);
        RestoringSums {
            gap_excess: gap - numbers.offset,
            restoring_weight: constraint.pressure_weight(&here),
        }
        .put(&mut point.terms);
        point.writes = [gap];
    }
}

/// Adds a correction to the gap of the outer state; of a unilateral constraint and of a smooth law.
pub static ADD_CORRECTION: [Kernel; 2] = [
    point_kernel!(
        add_correction, Sweep, gate Always, AddCorrection over Unilateral [] without law,
        reads [correction], writes [gap], sums [RestoringSums]
    ),
    point_kernel!(
        add_correction, Sweep, gate Always, AddCorrection over Smooth [],
        reads [correction], writes [gap], sums [RestoringSums]
    ),
];

/// The outer gap brought back to the prescribed mean.
struct RestoreOuterGap;

impl<T: Real, C: GapConstraint<T>> PointKernel<T, C, 0, 1, 0> for RestoreOuterGap {
    #[inline(always)]
    fn at(numbers: &Numbers<T, C>, law: &impl Cohesion<T>, point: &mut Point<T, 0, 1, 0>) {
        let ([gap], constraint) = (point.writes, &numbers.constraint);
        let here = here_at(constraint, law, gap, T::zero(), point.in_domain);
        point.writes = [gap - numbers.mean_gap_correction * constraint.pressure_weight(&here)];
    }
}

/// Brings the mean gap of the outer state back to the prescribed one; of the same two.
pub static RESTORE_OUTER_GAP: [Kernel; 2] = [
    point_kernel!(
        restore_outer_gap, Sweep, gate Always, RestoreOuterGap over Unilateral [] without law,
        reads [], writes [gap], sums []
    ),
    point_kernel!(
        restore_outer_gap, Sweep, gate Always, RestoreOuterGap over Smooth [],
        reads [], writes [gap], sums []
    ),
];
