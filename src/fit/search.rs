//! The least-squares problem of a model: which numbers are free, and which points of the curve interact.

use nalgebra::DVector;

use super::curve_file::Sample;
use super::indenter::Indenter;
use super::least_squares::Problem;
use super::measured::{Freedom, Measured};
use super::model::{IndenterModel, LAMBDAS, Model, Parameters};
use crate::theory::tabor_map::{Sphere, maugis_parameter};

/// Fewest points of a segment without force if the baseline is fitted too: one or two would only
/// fit their own noise.
const LEAST_FREE: usize = 3;
/// The same if its slope is fitted, too.
const LEAST_FREE_SLOPE: usize = 5;
/// Distance from first touch at which no tip interacts any more, over that of the fold.
const BEYOND_FOLD: f64 = 2.0;
/// A free number of the fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Variable {
    ContactModulus,
    WorkOfAdhesion,
    MaugisParameter,
    ApproachOffset,
    ForceOffset,
    BaselineSlope,
}

impl Variable {
    pub(super) fn name(self) -> &'static str {
        match self {
            Variable::ContactModulus => "contact_modulus",
            Variable::WorkOfAdhesion => "work_of_adhesion",
            Variable::MaugisParameter => "maugis_parameter",
            Variable::ApproachOffset => "approach_offset",
            Variable::ForceOffset => "force_offset",
            Variable::BaselineSlope => "baseline_slope",
        }
    }
}

/// The least-squares problem of a model: variables are logarithms of positive numbers, and offsets
/// as shares of the ranges.
pub(super) struct Search<'a> {
    pub(super) measured: &'a Measured,
    pub(super) tip: &'a IndenterModel,
    pub(super) variables: Vec<Variable>,
    /// The parameters at variables of 0.
    pub(super) start: Parameters,
}

impl Search<'_> {
    pub(super) fn parameters(&self, values: &DVector<f64>) -> Parameters {
        let mut found = self.start;
        for (variable, value) in self.variables.iter().zip(values.iter()) {
            match variable {
                Variable::ContactModulus => found.contact_modulus *= value.exp(),
                Variable::WorkOfAdhesion => found.work_of_adhesion *= value.exp(),
                Variable::MaugisParameter => {
                    let lambda = found.maugis_parameter * value.exp();
                    found.maugis_parameter = lambda.clamp(LAMBDAS.0, LAMBDAS.1);
                }
                Variable::ApproachOffset => {
                    found.approach_offset += value * self.unit(*variable);
                }
                Variable::ForceOffset => found.force_offset += value * self.unit(*variable),
                Variable::BaselineSlope => {
                    // About the middle of the curve: approach 0 may lie far outside, and there a small change of the
                    // slope would be a large one of the force.
                    let slope = value * self.unit(*variable);
                    found.baseline_slope += slope;
                    found.force_offset -= slope * self.measured.middle;
                }
            }
        }
        if let Some(range) = self.measured.freedom.range {
            found.maugis_parameter = lambda_of(&found, self.tip.indenter, range);
        }
        found
    }

    /// Scale of a variable that is not a logarithm.
    pub(super) fn unit(&self, variable: Variable) -> f64 {
        match variable {
            Variable::ApproachOffset => 0.1 * self.measured.approach_span,
            Variable::ForceOffset => 0.1 * self.measured.force_span,
            Variable::BaselineSlope => 0.1 * self.measured.force_span / self.measured.approach_span,
            _ => 1.0,
        }
    }

    /// Forces of a tip that interacts, and the numbers, which have the forces of a free one.
    fn interacting(&self, values: &DVector<f64>) -> Option<(Vec<f64>, Parameters)> {
        let parameters = self.parameters(values);
        let approaches = &self.measured.approaches;
        let forces = if let Some(beam) = &self.measured.beam {
            let contact = self.tip.contact(&parameters, approaches).ok()?;
            let contact = |approach: f64| contact(approach).unwrap_or((f64::NAN, f64::NAN));
            let baseline = (parameters.force_offset, parameters.baseline_slope);
            beam.forces(contact, baseline, approaches, self.measured.approach_span)
        } else {
            self.tip.forces(&parameters, approaches).ok()?
        };
        let finite = forces.iter().all(|force| force.is_finite());
        finite.then_some((forces, parameters))
    }

    fn residual(&self, sample: &Sample, force: f64) -> f64 {
        (force - sample.force) / self.measured.force_span
    }
}

impl Problem for Search<'_> {
    /// For each point, whether the tip interacts with the flat; else it is free.
    type Choice = Vec<bool>;

    /// On loading the tip is free first and interacts later, on unloading the reverse; the jump
    /// is placed where it fits the forces best.
    fn choose(&self, values: &DVector<f64>) -> Option<(Vec<bool>, DVector<f64>)> {
        let interacting = self.interacting(values)?;
        let samples = &self.measured.samples;
        let mut choice = vec![true; samples.len()];
        if self.tip.model == Model::Hertz && self.measured.freedom.baseline_slope {
            // It does not jump. A transition of its own would let a tilted baseline run on through the first points in
            // contact, and first touch would be less certain than is stated.
            let residuals = self.pick(&interacting, &choice);
            return Some((choice, residuals));
        }
        let least_free = match self.measured.freedom {
            Freedom {
                baseline_slope: true,
                ..
            } => LEAST_FREE_SLOPE,
            Freedom {
                force_offset: true, ..
            } => LEAST_FREE,
            _ => 1,
        };
        let lets_go = self.lets_go(&interacting.1);
        for segment in &self.measured.segments {
            let cost = |i: usize, force: f64| self.residual(&samples[i], force).powi(2);
            // Gain from treating a point as free.
            let gain = |i: usize| {
                let free = interacting.1.baseline(self.measured.place(i));
                cost(i, interacting.0[i]) - cost(i, free)
            };
            let mut order: Vec<usize> = segment.points.clone().collect();
            if !segment.loading {
                order.reverse();
            }
            let is_stateless = |i: &&usize| samples[**i].approach < lets_go;
            let stateless = order.iter().take_while(is_stateless).count();
            let (mut best, mut until, mut sum) = (0.0, 0, 0.0);
            for (count, i) in order.iter().enumerate() {
                sum += gain(*i);
                if count < stateless || (sum > best && count + 1 >= least_free) {
                    (best, until) = (sum, count + 1);
                }
            }
            for i in &order[..until] {
                choice[*i] = false;
            }
        }
        let residuals = self.pick(&interacting, &choice);
        Some((choice, residuals))
    }

    fn residuals(&self, values: &DVector<f64>, choice: &Vec<bool>) -> Option<DVector<f64>> {
        Some(self.pick(&self.interacting(values)?, choice))
    }
}

impl Search<'_> {
    /// Approach below which no tip interacts, m: farther from first touch than the fold by as much again, for the noise of an approach. A
    /// baseline that is fitted would make the force of the fold that of a free tip.
    fn lets_go(&self, parameters: &Parameters) -> f64 {
        let fold = self.tip.fold(parameters.maugis_parameter);
        let (_, unit) = self
            .tip
            .indenter
            .units(parameters.contact_modulus, parameters.work_of_adhesion);
        fold.map_or(f64::NEG_INFINITY, |fold| {
            parameters.approach_offset + BEYOND_FOLD * fold * unit
        })
    }

    fn pick(
        &self,
        (interacting, parameters): &(Vec<f64>, Parameters),
        choice: &[bool],
    ) -> DVector<f64> {
        let samples = &self.measured.samples;
        let each = (0..samples.len()).map(|i| {
            let force = if choice[i] {
                interacting[i]
            } else {
                parameters.baseline(self.measured.place(i))
            };
            self.residual(&samples[i], force)
        });
        DVector::from_iterator(samples.len(), each)
    }
}

/// Maugis' lambda of a range; 0 if the numbers are out of bounds.
fn lambda_of(parameters: &Parameters, indenter: Indenter, range: f64) -> f64 {
    Sphere::new(
        indenter.radius().unwrap_or(f64::NAN),
        parameters.contact_modulus,
        parameters.work_of_adhesion,
    )
    .and_then(|sphere| maugis_parameter(&sphere, parameters.work_of_adhesion / range))
    .unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The force of the fold, which the model has no state beyond, is that of a free tip on another baseline.
    #[test]
    fn a_tip_far_beyond_the_fold_is_free() {
        let (radius, start) = (
            1e-6,
            Parameters {
                contact_modulus: 1e6,
                work_of_adhesion: 0.01,
                ..Parameters::default()
            },
        );
        let tip = IndenterModel::new(Model::Jkr, radius);
        let approaches: Vec<f64> = (0..40).map(|i| 1e-8 * f64::from(i - 30)).collect();
        let forces = tip.forces(&start, &approaches).unwrap();
        let samples = approaches.iter().zip(forces);
        let samples = samples.map(|(&approach, force)| Sample { approach, force });
        let freedom = Freedom {
            approach_offset: true,
            force_offset: true,
            ..Freedom::default()
        };
        let measured = Measured::new(samples.collect(), radius, freedom);
        let variables = vec![Variable::ContactModulus, Variable::ForceOffset];
        let search = Search {
            measured: &measured,
            tip: &tip,
            variables,
            start,
        };
        let (choice, _) = search.choose(&DVector::zeros(2)).unwrap();
        let (_, unit) = tip
            .indenter
            .units(start.contact_modulus, start.work_of_adhesion);
        let lets_go = 2.0 * tip.fold(1.0).unwrap() * unit;
        assert!((-2.5e-7..-1e-8).contains(&lets_go), "{lets_go:e}");
        for (interacts, approach) in choice.iter().zip(&approaches) {
            assert_eq!(*interacts, *approach >= lets_go, "{approach:e}");
        }
    }
}
