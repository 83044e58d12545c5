//! A solid that relaxes: what its Maxwell branches carry from one step to the next.
//!
//! The pressure of a wave is its stiffness times `E_inf u + sum E_k m_k`, and each branch follows
//! `dm/dt + m/tau = du/dt`. Over a step of constant rate that is exactly
//! `m' = alpha m + beta (u' - u)` with `alpha = exp(-dt/tau)`, `beta = (tau/dt)(1 - alpha)`. So a
//! step is the elastic contact of a solid of modulus `E_inf + sum E_k beta_k` whose surface has
//! been moved by `sum E_k (alpha_k m_k - beta_k u)/E`, point by point.
//!
//! # Source
//! Taylor, Pister & Goudreau 1970; Simo & Hughes 1998, sec. 10.3.

use std::ops::Range;

use super::hand_over::{HandOver, HandedField};
use super::setup::Setup;
use crate::scene::{RelaxationScene, Scene, SolidScene};

/// Name of the displacement among the fields that are handed on.
const DISPLACEMENT: &str = "displacement";

/// Name of a branch's spring among them; the branch counts from 1.
fn spring_name(branch: usize) -> String {
    format!("spring {branch}")
}

/// The steps after the first `done`, cut where the modulus that they meet changes: one stretch
/// without relaxation, else one a duration.
pub(super) fn stretches(scene: &Scene, done: usize) -> Vec<Range<usize>> {
    let steps = done..scene.loading.path.len();
    match &scene.loading.durations {
        Some(durations) if !scene.solid.relaxation.is_empty() => {
            let mut stretches: Vec<Range<usize>> = Vec::new();
            for step in steps {
                match stretches.last_mut() {
                    Some(last) if durations[last.start] == durations[step] => last.end = step + 1,
                    _ => stretches.push(step..step + 1),
                }
            }
            stretches
        }
        _ => vec![steps],
    }
}

/// `(alpha, beta)` of a branch over a step, for the step's share of its relaxation time.
pub fn branch_coefficients(ratio: f64) -> (f64, f64) {
    // A step in no time meets the whole branch.
    let beta = if ratio > 0.0 {
        -(-ratio).exp_m1() / ratio
    } else {
        1.0
    };
    ((-ratio).exp(), beta)
}

/// Contact modulus that a step of `duration` (s) meets, Pa: from that at once to the relaxed one.
pub fn effective_modulus(solid: &SolidScene, duration: f64) -> f64 {
    solid
        .relaxation
        .iter()
        .fold(solid.contact_modulus, |modulus, branch| {
            modulus + branch.modulus * branch_coefficients(duration / branch.time).1
        })
}

/// The state of a solid that relaxes: its displacement and that of each branch's spring.
///
/// Displacements are reduced and hold one value a solved point.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// Displacement at the end of the last step.
    pub displacement: Vec<f64>,
    /// Displacement of the spring of each branch, in the order of the scene.
    pub springs: Vec<Vec<f64>>,
}

impl History {
    /// A solid at rest.
    pub fn at_rest(solid: &SolidScene, points: usize) -> History {
        History {
            displacement: vec![0.0; points],
            springs: vec![vec![0.0; points]; solid.relaxation.len()],
        }
    }

    /// The state from which a path goes on, or that at rest; `None` for a solid that does not relax.
    pub(super) fn of(setup: &Setup, hand_over: &HandOver) -> Option<History> {
        let solid = &setup.scene.solid;
        if solid.relaxation.is_empty() {
            return None;
        }
        let mut history = History::at_rest(solid, setup.problem.shape.len());
        if let Some(values) = hand_over.field(DISPLACEMENT) {
            history.displacement.copy_from_slice(values);
        }
        for (branch, spring) in history.springs.iter_mut().enumerate() {
            if let Some(values) = hand_over.field(&spring_name(branch + 1)) {
                spring.copy_from_slice(values);
            }
        }
        Some(history)
    }

    /// The fields from which a path goes on.
    pub(super) fn handed_fields(&self) -> Vec<HandedField> {
        let springs = self.springs.iter().enumerate();
        let mut fields: Vec<HandedField> = springs
            .map(|(branch, values)| HandedField {
                name: spring_name(branch + 1),
                values: values.clone(),
            })
            .collect();
        fields.push(HandedField {
            name: DISPLACEMENT.to_owned(),
            values: self.displacement.clone(),
        });
        fields
    }

    /// What the past moves the surface by over a step of `duration` (s), reduced: the pressure is
    /// that of the effective modulus on the displacement plus this.
    pub fn offset(&self, solid: &SolidScene, duration: f64) -> Vec<f64> {
        let mut offset = vec![0.0; self.displacement.len()];
        let modulus = effective_modulus(solid, duration);
        for (branch, spring) in self.branches(solid) {
            let (alpha, beta) = branch_coefficients(duration / branch.time);
            let weight = branch.modulus / modulus;
            for ((value, m), u) in offset.iter_mut().zip(spring).zip(&self.displacement) {
                *value += weight * (alpha * m - beta * u);
            }
        }
        offset
    }

    /// Ends a step of `duration` (s) at a displacement.
    pub fn advance(&mut self, solid: &SolidScene, duration: f64, displacement: Vec<f64>) {
        for (branch, spring) in solid.relaxation.iter().zip(&mut self.springs) {
            let (alpha, beta) = branch_coefficients(duration / branch.time);
            let steps = displacement.iter().zip(&self.displacement);
            for (m, (new, old)) in spring.iter_mut().zip(steps) {
                *m = alpha * *m + beta * (new - old);
            }
        }
        self.displacement = displacement;
    }

    /// The branches with their springs.
    pub fn branches<'a>(
        &'a self,
        solid: &'a SolidScene,
    ) -> impl Iterator<Item = (&'a RelaxationScene, &'a Vec<f64>)> {
        solid.relaxation.iter().zip(&self.springs)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solid() -> SolidScene {
        SolidScene {
            contact_modulus: 1.0,
            poisson_ratio: None,
            layer: None,
            hardness: None,
            relaxation: vec![RelaxationScene {
                modulus: 9.0,
                time: 0.1,
            }],
        }
    }

    /// One point under a constant pressure creeps as it was computed apart.
    #[test]
    fn creep_under_a_constant_pressure() {
        let solid = solid();
        let mut history = History::at_rest(&solid, 1);
        let step = |history: &mut History, duration: f64| {
            let displacement =
                1.0 / effective_modulus(&solid, duration) - history.offset(&solid, duration)[0];
            history.advance(&solid, duration, vec![displacement]);
            displacement
        };
        assert!((step(&mut history, 0.0) - 0.1).abs() < 1e-15);
        let mut found = 0.0;
        for _ in 0..50 {
            found = step(&mut history, 0.01);
        }
        assert!((found - 0.454101941).abs() < 1e-9, "{found}");
    }

    #[test]
    fn modulus_from_instant_to_relaxed() {
        assert_eq!(effective_modulus(&solid(), 0.0), 10.0);
        // (1 - exp(-1e9))/1e9 of the branch is left.
        assert!((effective_modulus(&solid(), 1e8) - 1.0 - 9e-9).abs() < 1e-15);
        assert!((effective_modulus(&solid(), 1e-12) - 10.0).abs() < 1e-9);
    }
}
