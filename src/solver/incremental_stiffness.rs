//! The incremental stiffness of a contact: its response to a further approach while no point opens or
//! closes.
//!
//! On the contact C the displacement is 1 and off it the pressure is 0: `P_C S p = 1` with S the
//! compliance, found by conjugate gradients. The stiffness K, cut to C, is the preconditioner: it inverts S
//! except near the edge and between spots. The result is the load `sum p`, whose error is of second
//! order in that of p.

use super::contact::ContactSolver;
use crate::backend::BackendError;
use crate::backend::long_field::LongField;

impl ContactSolver<'_> {
    /// Load that a unit displacement of the contact takes, reduced, summed over its points: 0
    /// without contact, infinite where a periodic cell is closed everywhere. `None` where the
    /// residual, as a share of the displacement, is above `tolerance` after `most` iterations, or where `watch`, which sees each of them
    /// with its residual, ends them.
    ///
    /// `contact` is 1 on the points of the grid that are in contact and 0 elsewhere. On a periodic
    /// cell the displacement counts from its mean, so that the solid far below adds nothing.
    /// Between solves only: it uses their directions as work space. The problem must be one
    /// [with conductance](super::Problem::with_conductance).
    pub fn incremental_stiffness(
        &mut self,
        contact: &[f64],
        tolerance: f64,
        most: usize,
        watch: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Option<f64>, BackendError> {
        let problem = self.problem.clone();
        let share = &problem.share;
        let touching = contact.iter().filter(|&&mask| mask > 0.0).count();
        let [touching] = share.counts([touching]);
        if touching == 0 {
            return Ok(Some(0.0));
        }
        let product = |a: &[f64], b: &[f64]| share.product(a, b);
        if touching == problem.shape.len() {
            return Ok(Some(f64::INFINITY));
        }
        let contact = problem.padded(contact, 0.0);
        let cut = |mut values: LongField<f64>| {
            values.iter_mut().zip(&contact).for_each(|(v, c)| *v *= c);
            values
        };
        let mut pressure = vec![0.0; contact.len()];
        let mut residual = contact.clone();
        let mut direction = vec![0.0; contact.len()];
        let mut before = f64::INFINITY;
        for iteration in 1..=most {
            let descent = cut(self.stiffness_times(&residual)?);
            let along = product(&residual, &descent);
            let beta = along / before;
            for (d, z) in direction.iter_mut().zip(&descent) {
                *d = z + beta * *d;
            }
            drop(descent);
            before = along;
            let moved = cut(self.compliance_times(&direction)?);
            let step = along / product(&direction, &moved);
            for ((p, r), (d, m)) in pressure
                .iter_mut()
                .zip(&mut residual)
                .zip(direction.iter().zip(&moved))
            {
                *p += step * d;
                *r -= step * m;
            }
            let left = (product(&residual, &residual) / touching as f64).sqrt();
            if left <= tolerance {
                return Ok(Some(share.sum(&pressure)));
            }
            if !left.is_finite() || !watch(iteration, left) {
                return Ok(None);
            }
        }
        Ok(None)
    }
}
